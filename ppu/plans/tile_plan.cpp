#include "ppu/plans/tile_plan.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/plans/lattice_sums.h"
#include "ppu/plans/match_constants.h"
#include "ppu/plans/plan_writer.h"
#include "ppu/plans/tile_places.h"
#include "ppu/plans/tile_scheduler.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

using Direction = TileScheduler::Direction;

constexpr int kTilesWanted = 24;  // enough that six SPEs end a pass at nearly the same time
constexpr int kMostPlanes = 64;   // the local store keeps the slices of a tile

int round_up(int count, int step) { return (count + step - 1) / step * step; }

/// Tiles begin where sums start anew, so that no sum is made twice only to begin a chain.
int most_rows(const Lattice<3>& lattice, int half_width, std::uint32_t arena_bytes) {
  const int fit = rows_that_fit(lattice, half_width, arena_bytes);
  return fit < kSumRestart ? fit : fit / kSumRestart * kSumRestart;
}

TileGrid grid_for(const Lattice<3>& lattice, int tile_rows, TileShape shape) {
  SC_ASSERT(!lattice.particles.empty(), "{} cells without particles", lattice.cells.size());
  const auto [low, high] = std::ranges::minmax(lattice.particles, {}, [](const auto& p) { return p.x(); });
  const int planes = high.x() - low.x() + 1;
  const auto [front, back] = std::ranges::minmax(lattice.particles, {}, [](const auto& p) { return p.y(); });
  const int rows = back.y() - front.y() + 1;

  const int strips = (rows + tile_rows - 1) / tile_rows;
  const int slabs = std::max(1, kTilesWanted / strips);
  const int tile_planes = shape.planes > 0
                              ? shape.planes
                              : std::min(round_up((planes + slabs - 1) / slabs, kSumRestart), kMostPlanes);
  SC_ASSERT(tile_planes > 0 && tile_rows > 0, "tiles of {} planes and {} rows", tile_planes, tile_rows);
  return {tile_planes, tile_rows};
}

std::vector<Eigen::Vector3i> homes(const Lattice<3>& lattice, const LatticeSums& order) {
  std::vector<Eigen::Vector3i> sites;
  for (const std::uint32_t particle : order.home) sites.push_back(lattice.particles[particle]);
  return sites;
}

/// A body, cut into tiles of one size.
struct Tiling {
  TilePlaces particles, regions;
  std::vector<TilePlan::Tile> tiles{};
  spu::TileLimits up{}, down{};  ///< of the tiles that were cut
  std::vector<std::uint32_t> lists{};
  std::vector<dma::ElementRun> record{};

  std::uint32_t bytes() const { return std::max(spu::tile_up_bytes(up), spu::tile_down_bytes(down)); }
};

/// Stops at the first tile that does not fit.
Tiling cut(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching, const LatticeSums& order,
           const TileGrid& grid, std::uint32_t arena_bytes) {
  Tiling cut{TilePlaces(grid, lattice.particles), TilePlaces(grid, homes(lattice, order))};
  TileScheduler scheduler(lattice, matching.sums(), matching.half_width(), order, grid, cut.particles,
                          cut.regions);
  std::map<std::pair<int, int>, std::size_t> particles_of;  // for each tile
  for (const Eigen::Vector3i& index : lattice.particles) ++particles_of[grid.tile_of(index)];
  const auto fits = [&] {
    cut.up = scheduler.limits(Direction::kUp);
    cut.down = scheduler.limits(Direction::kDown);
    return spu::tile_fits(cut.up, cut.down, arena_bytes);
  };
  // If any tile does not fit, it is most likely the fullest.
  const auto fullest = std::ranges::max_element(
      particles_of, {},
      [](const std::pair<const std::pair<int, int>, std::size_t>& tile) { return tile.second; });
  scheduler.slices(fullest->first, Direction::kUp);
  scheduler.slices(fullest->first, Direction::kDown);
  if (!fits()) return cut;
  for (const auto& [number, count] : particles_of) {
    TilePlan::Tile& tile = cut.tiles.emplace_back();
    tile.up = scheduler.slices(number, Direction::kUp);
    tile.down = scheduler.slices(number, Direction::kDown);
    tile.damp = scheduler.slices_for_twists();
    if (!fits()) return cut;
  }
  cut.lists = scheduler.lists().release();
  const auto record = scheduler.lists().record();
  cut.record.assign(record.begin(), record.end());
  return cut;
}

/// Estimates rows from the height of the lattice alone. In a lattice that is not a block, more sums belong to single regions, and lists are
/// longer.
Tiling cut_to_fit(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching, const LatticeSums& order,
                  TileShape shape, std::uint32_t arena_bytes) {
  int rows = shape.rows > 0 ? shape.rows : most_rows(lattice, matching.half_width(), arena_bytes);
  for (;; --rows) {
    Tiling tiling = cut(lattice, matching, order, grid_for(lattice, rows, shape), arena_bytes);
    if (spu::tile_fits(tiling.up, tiling.down, arena_bytes)) return tiling;
    if (shape.rows > 0 || rows == 1)
      throw BodyTooLarge("a tile of " + std::to_string(rows) + " rows of a soft body needs " +
                         std::to_string(tiling.bytes()) +
                         " bytes of local store; the kernel match_tiles has " + std::to_string(arena_bytes) +
                         "; turn the body so that its lattice is lower along z");
  }
}

}  // namespace

TilePlan::TilePlan(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching, TileShape shape,
                   std::uint32_t arena_bytes) {
  if (shape.planes < 0 || shape.rows < 0)
    throw std::invalid_argument("TilePlan: a tile of " + std::to_string(shape.planes) + " planes and " +
                                std::to_string(shape.rows) + " rows; expected 0 or more of both");
  const SumPlan& sums = matching.sums();
  const LatticeSums order(lattice, sums, sum_restart_of_rows(lattice, matching.half_width()));
  Tiling tiling = cut_to_fit(lattice, matching, order, shape, arena_bytes);
  const TilePlaces &particles = tiling.particles, &regions = tiling.regions;
  tiles_ = std::move(tiling.tiles);
  lists_ = std::move(tiling.lists);
  record_of_lists_ = std::move(tiling.record);
  body_.tiles = static_cast<std::uint32_t>(tiles_.size());
  body_.up = tiling.up;
  body_.down = tiling.down;
  body_.noise_floor = matching.noise_floor();
  body_.grid = origin_grid(lattice.spacing);
  body_.hold = hold_of(lattice, matching);
  std::ranges::transform(samples_of(matching), body_.samples,
                         [&](std::uint32_t i) { return particles.place_of(i); });

  SC_ASSERT(particles.all_places().size() == matching.particles(), "places for {} particles of {}",
            particles.all_places().size(), matching.particles());
  place_of_.assign(particles.all_places().begin(), particles.all_places().end());
  SC_ASSERT(particles.size() % 4 == 0 && regions.size() % 4 == 0,
            "{} places of particles and {} of regions are not multiples of 4", particles.size(),
            regions.size());
  rest_.resize(particles.size() / 4);
  weights_.resize(rest_.size());
  for (std::uint32_t i = 0; i < matching.particles(); ++i) {
    const auto& particle = matching.particle_constants()[i];
    const std::uint32_t group = place_of_[i] / 4, lane = place_of_[i] % 4;
    std::ranges::copy(rest_moment(particle), rest_[group].rest_moment[lane]);
    weights_[group].inverse_mass[lane] = 1 / particle.mass;
    weights_[group].mass[lane] = particle.mass;
  }
  SC_ASSERT(regions.all_places().size() == sums.regions(), "places for {} regions of {}",
            regions.all_places().size(), sums.regions());
  place_of_region_.assign(regions.all_places().begin(), regions.all_places().end());
  regions_.resize(regions.size() / 4);
  for (std::uint32_t r = 0; r < sums.regions(); ++r) {
    const auto& region = matching.region_constants()[r];
    const std::uint32_t group = regions.place_of(r) / 4, lane = regions.place_of(r) % 4;
    set_centre(regions_[group], lane, region);
    regions_[group].inverse_mass[lane] = region.inverse_mass;
  }
}

}  // namespace softcell::ppu
