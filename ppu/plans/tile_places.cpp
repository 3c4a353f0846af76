#include "ppu/plans/tile_places.h"

#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

int divide_down(int a, int b) { return (a - (a % b + b) % b) / b; }

}  // namespace

std::pair<int, int> TileGrid::tile_of(const Eigen::Vector3i& index) const {
  SC_ASSERT(planes > 0 && rows > 0, "tiles of {} planes and {} rows", planes, rows);
  return {divide_down(index.x(), planes), divide_down(index.y(), rows)};
}

TilePlaces::TilePlaces(const TileGrid& grid, const std::vector<Eigen::Vector3i>& sites) {
  std::pair<int, int> current;  // plane, tile row
  for (std::uint32_t thing = 0; thing < sites.size(); ++thing) {
    const std::pair<int, int> here{sites[thing].x(), grid.tile_of(sites[thing]).second};
    if (thing == 0 || here != current) {
      while (thing_at_.size() % 4 != 0) thing_at_.push_back(kPadding);
      SC_ASSERT(!stretches_.contains(here), "plane {} has tile row {} in two pieces: sites do not ascend",
                here.first, here.second);
      stretches_[here].begin = size();
      current = here;
    }
    place_of_.push_back(size());
    thing_at_.push_back(thing);
    stretches_[here].end = (size() + 3) / 4 * 4;
  }
  while (thing_at_.size() % 4 != 0) thing_at_.push_back(kPadding);
}

TilePlaces::Stretch TilePlaces::stretch(int x, int tile_row) const {
  const auto found = stretches_.find({x, tile_row});
  return found == stretches_.end() ? Stretch{} : found->second;
}

}  // namespace softcell::ppu
