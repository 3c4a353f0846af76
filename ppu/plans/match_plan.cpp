#include "ppu/plans/match_plan.h"

#include <algorithm>
#include <span>
#include <vector>

#include "ppu/plans/lattice_sums.h"
#include "ppu/plans/match_constants.h"
#include "ppu/plans/plan_writer.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

spu::MatchParticles particles_at(const MatchingPlan<float, 3>& matching, std::size_t first,
                                 std::span<const std::uint32_t> region_of) {
  SC_ASSERT(region_of.size() == matching.particles(), "the regions of {} particles of {}", region_of.size(),
            matching.particles());
  spu::MatchParticles group{};
  for (std::size_t lane = 0; lane < 4 && first + lane < matching.particles(); ++lane) {
    const auto& particle = matching.particle_constants()[first + lane];
    std::ranges::copy(rest_moment(particle), group.rest_moment[lane]);
    group.inverse_mass[lane] = 1 / particle.mass;
    group.mass[lane] = particle.mass;
    group.region[lane] = (region_of[first + lane] + 1) * (spu::kMatchSlotBytes / spu::kSumOffsetUnit);
  }
  return group;
}

/// @param first  rank of the first of four regions
spu::MatchRegions regions_at(const MatchingPlan<float, 3>& matching, std::size_t first,
                             const LatticeSums& order) {
  SC_ASSERT(first % 4 == 0 && first < order.regions.size(), "four regions from {} of {}", first,
            order.regions.size());
  spu::MatchRegions group{};
  for (std::size_t lane = 0; lane < 4 && first + lane < order.regions.size(); ++lane) {
    const auto& region = matching.region_constants()[order.region_at_slot[first + lane + 1]];
    set_centre(group, static_cast<std::uint32_t>(lane), region);
    group.inverse_mass[lane] = region.inverse_mass;
  }
  return group;
}

constexpr SumListFormat kFormat{spu::kMatchSlotBytes, kSumRestart};

}  // namespace

MatchPlan::MatchPlan(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching,
                     std::uint32_t arena_bytes) {
  SC_ASSERT(lattice.particles.size() == matching.particles(), "a lattice of {} particles, matching of {}",
            lattice.particles.size(), matching.particles());
  const SumPlan& sums = matching.sums();
  LatticeSums order(lattice, sums, sum_restart_of_rows(lattice, matching.half_width()));
  for (const std::uint32_t r : sums.region_of()) region_of_.push_back(order.region_slot[r] - 1);

  const std::size_t particle_groups = (matching.particles() + 3) / 4,
                    region_groups = (sums.regions() + 3) / 4;
  const std::size_t slots = 1 + std::max({4 * particle_groups, order.bars_of_particles.size(),
                                          order.plates.size(), 4 * region_groups});
  // Checked before lists are written, as their offsets would not fit: the least that the buffers need.
  static_assert(2 * spu::kMatchSlotBytes * kFormat.max_slot() > spu::kMatchArenaBytes);
  check_fits("match", matching.particles(), std::uint64_t{slots} * 2 * spu::kMatchSlotBytes, arena_bytes);

  std::vector<spu::MatchParticles> particle_constants;
  for (std::size_t i = 0; i < matching.particles(); i += 4)
    particle_constants.push_back(particles_at(matching, i, region_of_));
  std::vector<spu::MatchRegions> region_constants;
  for (std::size_t r = 0; r < sums.regions(); r += 4)
    region_constants.push_back(regions_at(matching, r, order));

  for (std::size_t pad = sums.regions(); pad < 4 * region_groups; ++pad) order.regions.push_nothing();
  SC_ASSERT(particle_constants.size() == particle_groups && region_constants.size() == region_groups &&
                order.regions.size() == 4 * region_groups,
            "{} groups of particles, {} of regions, {} sums", particle_constants.size(),
            region_constants.size(), order.regions.size());
  const auto list = [](const SumLevel& level) { return write_sum_list(level, spu::kMatchSlotBytes); };
  const SumList from_particles = list(order.bars_of_particles), from_regions = list(order.bars_of_regions);
  const SumList of_plates = list(order.plates), of_regions = list(order.regions);
  additions_ = from_particles.additions + of_plates.additions + of_regions.additions;

  PlanWriter writer(sizeof(spu::MatchPlanHeader));
  spu::MatchPlanHeader header{};
  header.particles = static_cast<std::uint32_t>(matching.particles());
  header.regions = static_cast<std::uint32_t>(sums.regions());
  header.slots = static_cast<std::uint32_t>(slots);
  header.particle_constants = writer.append(particle_constants);
  header.region_constants = writer.append(region_constants);
  header.bars_of_particles = writer.append(from_particles.halfwords);
  header.bars_of_regions = from_regions.halfwords == from_particles.halfwords
                               ? header.bars_of_particles
                               : writer.append(from_regions.halfwords);
  header.plates = writer.append(of_plates.halfwords);
  header.regions_of_plates = writer.append(of_regions.halfwords);
  header.noise_floor = matching.noise_floor();
  header.grid = origin_grid(lattice.spacing);
  header.hold = hold_of(lattice, matching);
  std::ranges::copy(samples_of(matching), header.samples);
  header.bytes = writer.size();
  check_fits("match", matching.particles(), spu::match_local_store_bytes(header), arena_bytes);
  assign(writer.finish(header), writer.record());
}

}  // namespace softcell::ppu
