#include "ppu/plans/lattice_sums.h"

#include <algorithm>
#include <limits>

#include "match_tiles_job.h"
#include "ppu/plans/sum_order.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

LatticeSums::LatticeSums(const Lattice<3>& lattice, const SumPlan& sums, int plate_restart)
    : home(sums.regions(), std::numeric_limits<std::uint32_t>::max()) {
  SC_ASSERT(lattice.particles.size() == sums.particles() && plate_restart > 0,
            "a lattice of {} particles, sums of {}, a restart after {} rows", lattice.particles.size(),
            sums.particles(), plate_restart);
  const Stations stations(lattice.particles, sums);
  const Order bar_order(stations.bars), plate_order(stations.plates), region_order(stations.regions);
  const auto level = [](const Csr& lists, const std::vector<Station>& at, const Order& order, int restart,
                        const auto& slot_of) {
    return sum_level(ordered_sums(
                         at, order, [&](std::uint32_t item) { return lists[item]; }, slot_of),
                     restart);
  };
  const auto slot_by = [](const Order& order) {
    return [&order](std::uint32_t item) { return order.slot[item]; };
  };
  const auto particle_slot = [](std::uint32_t i) { return i + 1; };
  bars_of_particles = level(sums.particles_of_bar(), stations.bars, bar_order, kSumRestart, particle_slot);
  bars_of_regions =
      level(sums.regions_of_bar(), stations.bars, bar_order, kSumRestart, slot_by(region_order));
  plates = level(sums.bars_of_plate(), stations.plates, plate_order, plate_restart, slot_by(bar_order));
  regions = level(sums.plates_of_region(), stations.regions, region_order, kSumRestart, slot_by(plate_order));

  region_slot = region_order.slot;
  region_at_slot.assign(1, 0);
  region_at_slot.insert(region_at_slot.end(), region_order.item.begin(), region_order.item.end());
  for (auto i = static_cast<std::uint32_t>(sums.particles()); i-- > 0;) home[sums.region_of()[i]] = i;
  SC_ASSERT(region_at_slot.size() == sums.regions() + 1 && std::ranges::max(home) < sums.particles(),
            "{} slots of {} regions, of which some have no particle of {}", region_at_slot.size(),
            sums.regions(), sums.particles());
}

int rows_that_fit(const Lattice<3>& lattice, int half_width, std::uint32_t arena_bytes) {
  SC_ASSERT(!lattice.particles.empty() && half_width >= 0, "{} particles in regions of half-width {}",
            lattice.particles.size(), half_width);
  const auto [low, high] = std::ranges::minmax(lattice.particles, {}, [](const auto& p) { return p.z(); });
  const std::uint64_t height = static_cast<std::uint64_t>(high.z() - low.z()) + 1;
  const auto w = static_cast<std::uint64_t>(half_width);
  const auto bytes = [&](std::uint64_t rows) {
    const std::uint64_t in = (rows + 2 * w) * height, out = rows * height;  // particles of a slice
    // A step of a chain takes 4 bytes of list, one of a run 6. Two slices of regions and 2 w + 2 of plates are alive.
    const spu::TileLimits up{.slices = 64,
                             .input_groups = static_cast<std::uint32_t>(in / 4 + 1),
                             .output_groups = static_cast<std::uint32_t>(out / 4 + 1),
                             .lists_bytes = static_cast<std::uint32_t>(4 * in + 10 * out + 256),
                             .slots = static_cast<std::uint32_t>(2 * in + (2 * w + 4) * out)};
    spu::TileLimits down = up;
    down.lists_bytes += static_cast<std::uint32_t>(4 * out);
    down.slots += static_cast<std::uint32_t>(in);
    return std::max(spu::tile_up_bytes(up), spu::tile_down_bytes(down));
  };
  int rows = 1;
  while (rows < kMaxLatticeCellsPerAxis && bytes(static_cast<std::uint64_t>(rows) + 1) <= arena_bytes) ++rows;
  return rows;
}

int sum_restart_of_rows(const Lattice<3>& lattice, int half_width) {
  return std::min(rows_that_fit(lattice, half_width, spu::kTileArenaBytes), kSumRestart);
}

}  // namespace softcell::ppu
