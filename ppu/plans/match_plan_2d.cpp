#include "ppu/plans/match_plan_2d.h"

#include <algorithm>
#include <span>
#include <vector>

#include "ppu/matching/one_plate.h"
#include "ppu/plans/plan_writer.h"
#include "ppu/plans/sum_order.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

constexpr SumListFormat kFormat2d{spu::kMatch2dSlotBytes, MatchPlan2d::kRestart};

spu::MatchParticles2d particles_at(const MatchingPlan<float, 2>& matching, std::size_t first,
                                   std::span<const std::uint32_t> region_of) {
  SC_ASSERT(region_of.size() == matching.particles(), "the regions of {} particles of {}", region_of.size(),
            matching.particles());
  spu::MatchParticles2d group{};
  for (std::size_t lane = 0; lane < 4 && first + lane < matching.particles(); ++lane) {
    const auto& particle = matching.particle_constants()[first + lane];
    group.rest_x[lane] = particle.x0.x();
    group.rest_y[lane] = particle.x0.y();
    group.modified_mass[lane] = particle.modified_mass;
    group.share[lane] = particle.inverse_region_count;
    group.mass[lane] = particle.mass;
    group.region[lane] = (region_of[first + lane] + 1) * (spu::kMatch2dSlotBytes / spu::kSumOffsetUnit);
  }
  return group;
}

spu::MatchRegions2d regions_at(const MatchingPlan<float, 2>& matching, std::size_t first,
                               const Order& order) {
  SC_ASSERT(first % 4 == 0 && first < order.item.size(), "four regions from {} of {}", first,
            order.item.size());
  spu::MatchRegions2d group{};
  for (std::size_t lane = 0; lane < 4 && first + lane < order.item.size(); ++lane) {
    const auto& region = matching.region_constants()[order.item[first + lane]];
    group.centre_x[lane] = region.c0.x();
    group.centre_y[lane] = region.c0.y();
    group.inverse_mass[lane] = region.inverse_mass;
  }
  return group;
}

}  // namespace

MatchPlan2d::MatchPlan2d(const Lattice<2>& lattice, const MatchingPlan<float, 2>& matching) {
  SC_ASSERT(lattice.particles.size() == matching.particles(), "a lattice of {} particles, matching of {}",
            lattice.particles.size(), matching.particles());
  const SumPlan& sums = matching.sums();
  const Stations stations(as_one_plate(lattice.particles), sums);
  // A region has one plate.
  const auto plate_of = [&](std::uint32_t region) { return sums.plates_of_region()[region][0]; };
  std::vector<Station> region_stations;
  for (std::uint32_t r = 0; r < sums.regions(); ++r) region_stations.push_back(stations.plates[plate_of(r)]);
  const Order bars(stations.bars), regions(region_stations);
  for (const std::uint32_t r : sums.region_of()) region_of_.push_back(regions.slot[r] - 1);

  const std::size_t particle_groups = (matching.particles() + 3) / 4,
                    region_groups = (sums.regions() + 3) / 4;
  const std::size_t slots = 1 + std::max({4 * particle_groups, bars.item.size(), 4 * region_groups});
  // Checked before lists are written, as their offsets would not fit: the least that the buffers need.
  static_assert(2 * spu::kMatch2dSlotBytes * kFormat2d.max_slot() > spu::kMatch2dArenaBytes);
  check_fits("match_2d", matching.particles(), std::uint64_t{slots} * 2 * spu::kMatch2dSlotBytes,
             spu::kMatch2dArenaBytes);

  std::vector<spu::MatchParticles2d> particle_constants;
  for (std::size_t i = 0; i < matching.particles(); i += 4)
    particle_constants.push_back(particles_at(matching, i, region_of_));
  std::vector<spu::MatchRegions2d> region_constants;
  for (std::size_t r = 0; r < sums.regions(); r += 4)
    region_constants.push_back(regions_at(matching, r, regions));

  SC_ASSERT(particle_constants.size() == particle_groups && region_constants.size() == region_groups,
            "{} groups of particles and {} of regions, for {} and {}", particle_constants.size(),
            region_constants.size(), particle_groups, region_groups);
  const SumList from_particles = ordered_sum_list(
      stations.bars, bars, [&](std::uint32_t b) { return sums.particles_of_bar()[b]; },
      [](std::uint32_t i) { return i + 1; }, kFormat2d);
  const SumList from_regions = ordered_sum_list(
      stations.bars, bars, [&](std::uint32_t b) { return sums.regions_of_bar()[b]; },
      [&](std::uint32_t r) { return regions.slot[r]; }, kFormat2d);
  const SumList of_regions = ordered_sum_list(
      region_stations, regions, [&](std::uint32_t r) { return sums.bars_of_plate()[plate_of(r)]; },
      [&](std::uint32_t b) { return bars.slot[b]; }, kFormat2d, 4 * region_groups - sums.regions());
  additions_ = from_particles.additions + of_regions.additions;

  PlanWriter writer(sizeof(spu::MatchPlanHeader2d));
  spu::MatchPlanHeader2d header{};
  header.particles = static_cast<std::uint32_t>(matching.particles());
  header.regions = static_cast<std::uint32_t>(sums.regions());
  header.slots = static_cast<std::uint32_t>(slots);
  header.particle_constants = writer.append(particle_constants);
  header.region_constants = writer.append(region_constants);
  header.bars_of_particles = writer.append(from_particles.halfwords);
  header.bars_of_regions = writer.append(from_regions.halfwords);
  header.regions_of_bars = writer.append(of_regions.halfwords);
  header.noise_floor = matching.noise_floor();
  header.grid = origin_grid(lattice.spacing);
  header.inverse_particles = 1 / static_cast<float>(header.particles);
  header.inverse_mass = inverse_body_mass(matching.particle_constants());
  header.bytes = writer.size();
  check_fits("match_2d", matching.particles(), spu::match_2d_local_store_bytes(header),
             spu::kMatch2dArenaBytes);
  assign(writer.finish(header), writer.record());
}

}  // namespace softcell::ppu
