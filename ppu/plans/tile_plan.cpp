#include "ppu/plans/tile_plan.h"

#include <algorithm>
#include <set>
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

constexpr int kTilesWanted = 24;  // enough for six SPEs to end a pass at nearly the same time
constexpr int kMostPlanes = 64;   // slices of a tile are kept in the local store

int round_up(int count, int step) { return (count + step - 1) / step * step; }

/// Tiles begin where sums start anew, so that they make no sums twice for a chain's sake.
TileGrid grid_for(const Lattice<3>& lattice, int half_width, TileShape shape, std::uint32_t arena_bytes) {
  SC_ASSERT(!lattice.particles.empty(), "{} cells without particles", lattice.cells.size());
  const auto [low, high] = std::ranges::minmax(lattice.particles, {}, [](const auto& p) { return p.x(); });
  const int planes = high.x() - low.x() + 1;
  const auto [front, back] = std::ranges::minmax(lattice.particles, {}, [](const auto& p) { return p.y(); });
  const int rows = back.y() - front.y() + 1;

  const int fit = rows_that_fit(lattice, half_width, arena_bytes);
  const int tile_rows = shape.rows > 0      ? shape.rows
                        : fit < kSumRestart ? fit
                                            : fit / kSumRestart * kSumRestart;
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

}  // namespace

TilePlan::TilePlan(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching, TileShape shape,
                   std::uint32_t arena_bytes) {
  if (shape.planes < 0 || shape.rows < 0)
    throw std::invalid_argument("TilePlan: a tile of " + std::to_string(shape.planes) + " planes and " +
                                std::to_string(shape.rows) + " rows; expected 0 or more of both");
  const SumPlan& sums = matching.sums();
  const LatticeSums order(lattice, sums, sum_restart_of_rows(lattice, matching.half_width()));
  const TileGrid grid = grid_for(lattice, matching.half_width(), shape, arena_bytes);
  const TilePlaces particles(grid, lattice.particles), regions(grid, homes(lattice, order));

  TileScheduler scheduler(lattice, sums, matching.half_width(), order, grid, particles, regions);
  std::set<std::pair<int, int>> numbers;
  for (const Eigen::Vector3i& index : lattice.particles) numbers.insert(grid.tile_of(index));
  for (const std::pair<int, int>& number : numbers) {
    Tile& tile = tiles_.emplace_back();
    tile.up = scheduler.slices(number, Direction::kUp);
    tile.down = scheduler.slices(number, Direction::kDown);
    tile.damp = scheduler.slices_for_twists();
  }
  lists_ = scheduler.lists().release();
  const auto record = scheduler.lists().record();
  record_of_lists_.assign(record.begin(), record.end());

  body_.tiles = static_cast<std::uint32_t>(tiles_.size());
  body_.up = scheduler.limits(Direction::kUp);
  body_.down = scheduler.limits(Direction::kDown);
  if (!spu::tile_fits(body_.up, body_.down, arena_bytes))
    throw BodyTooLarge(
        "a tile of " + std::to_string(grid.rows) + " rows of a soft body needs " +
        std::to_string(std::max(spu::tile_up_bytes(body_.up), spu::tile_down_bytes(body_.down))) +
        " bytes of local store; the kernel match_tiles has " + std::to_string(arena_bytes) +
        "; turn the body so that its lattice is lower along z");
  body_.noise_floor = matching.noise_floor();
  body_.grid = origin_grid(lattice.spacing);
  body_.hold = hold_of(lattice, matching);
  std::ranges::transform(samples_of(matching), body_.samples,
                         [&](std::uint32_t i) { return particles.place_of(i); });

  SC_ASSERT(particles.all_places().size() == matching.particles(), "places for {} particles of {}",
            particles.all_places().size(), matching.particles());
  place_of_.assign(particles.all_places().begin(), particles.all_places().end());
  SC_ASSERT(particles.size() % 4 == 0 && regions.size() % 4 == 0,
            "{} places of particles and {} of regions, no groups of four", particles.size(), regions.size());
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
