#pragma once
// Sums over all regions at once. Regions that overlap share the work.
//
// A region is cut into plates (its particles of equal x), a plate into bars (equal x and y). Neighbouring
// regions have most of their bars and plates in common, and each of those is added up only once:
//
//     particles --> bars --> plates --> regions
//     at most 6 w additions for each particle in place of (2w+1)^3 - 1
//
// Equal sets are stored once, however irregular the lattice, and that includes regions: a sheet one cell thick has half as many regions as
// particles. The naive sum also adds bar by bar and plate by plate, but shares nothing; both give the same bits.
//
// Membership is symmetric, so "sum over the particles of region r" and "sum over the regions that hold particle i" are the same operator on
// a lattice with one region per particle: the way down needs no lists of its own.

#include <span>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// How the sums of one lattice's regions are made. Immutable after construction, shared by all bodies of a model.
/// @source  [LSM07]
class SumPlan {
 public:
  /// @param particles  grid indices, sorted by x, then y, then z.
  /// @param regions    as find_regions() makes them for these particles.
  /// @throws std::invalid_argument  not one region per particle, or membership not symmetric.
  SumPlan(std::span<const Eigen::Vector3i> particles, const Csr& regions);
  SumPlan(const Lattice<3>& lattice, const Csr& regions) : SumPlan(lattice.particles, regions) {}

  std::size_t particles() const { return region_of_.size(); }
  /// Number of distinct regions. They are numbered in the order of the lowest particle that has them.
  std::size_t regions() const { return plates_of_region_.size(); }

  /// Particle -> the number of its region. Particles with the same number lie in the same regions.
  std::span<const std::uint32_t> region_of() const { return region_of_; }
  const Csr& particles_of_bar() const { return particles_of_bar_; }
  const Csr& regions_of_bar() const { return regions_of_bar_; }  ///< the region of each particle of the bar
  const Csr& bars_of_plate() const { return bars_of_plate_; }
  const Csr& plates_of_region() const { return plates_of_region_; }

  /// The particles of a distinct region, ascending.
  std::vector<std::uint32_t> members(std::size_t region) const;

 private:
  Csr particles_of_bar_, regions_of_bar_, bars_of_plate_, plates_of_region_;
  std::vector<std::uint32_t> region_of_;
};

/// Partial sums of one shared sum; allocated once, used by every call.
template <typename Payload>
struct SumScratch {
  explicit SumScratch(const SumPlan& plan)
      : bars(plan.particles_of_bar().size()), plates(plan.bars_of_plate().size()) {}
  std::vector<Payload> bars, plates;
};

namespace detail {

/// out[i] = sum of in over list i, in the order of the list. No list is empty.
template <typename Payload>
void sum_lists(const Csr& lists, const Payload* in, Payload* out) {
  SC_ASSERT(lists.items.size() == lists.offsets.back(), "{} lists end at {} of {} items", lists.size(),
            lists.offsets.back(), lists.items.size());
  const std::uint32_t* item = lists.items.data();
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const std::uint32_t* const end = lists.items.data() + lists.offsets[i + 1];
    Payload sum = in[*item++];
    while (item != end) sum += in[*item++];
    out[i] = sum;
  }
}

/// The sum over one region, bar by bar and plate by plate; `value(particle)` is what is added.
template <typename Payload, typename Value>
Payload sum_region_naively(const SumPlan& plan, std::size_t region, const Value& value) {
  const auto sum_of = [](std::span<const std::uint32_t> list, const auto& term) {
    Payload sum = term(list[0]);
    for (const std::uint32_t item : list.subspan(1)) sum += term(item);
    return sum;
  };
  const auto bar = [&](std::uint32_t b) { return sum_of(plan.particles_of_bar()[b], value); };
  const auto plate = [&](std::uint32_t p) { return sum_of(plan.bars_of_plate()[p], bar); };
  return sum_of(plan.plates_of_region()[region], plate);
}

}  // namespace detail

/// Up: regions[r] = sum of particles[i] over the particles i of distinct region r. `Payload` needs copying
/// and +=.
/// @pre  One value per particle and one per distinct region.
template <typename Payload>
void sum_up(const SumPlan& plan, std::span<const Payload> particles, SumScratch<Payload>& scratch,
            std::span<Payload> regions) {
  SC_ASSERT(particles.size() == plan.particles() && regions.size() == plan.regions(),
            "{} values for {} particles, {} sums for {} regions", particles.size(), plan.particles(),
            regions.size(), plan.regions());
  detail::sum_lists(plan.particles_of_bar(), particles.data(), scratch.bars.data());
  detail::sum_lists(plan.bars_of_plate(), scratch.bars.data(), scratch.plates.data());
  detail::sum_lists(plan.plates_of_region(), scratch.plates.data(), regions.data());
}

/// The same, without sharing.
template <typename Payload>
void sum_up_naively(const SumPlan& plan, std::span<const Payload> particles, std::span<Payload> regions) {
  SC_ASSERT(particles.size() == plan.particles() && regions.size() == plan.regions(),
            "{} values for {} particles, {} sums for {} regions", particles.size(), plan.particles(),
            regions.size(), plan.regions());
  const auto value = [&](std::uint32_t particle) -> const Payload& { return particles[particle]; };
  for (std::size_t r = 0; r < plan.regions(); ++r)
    regions[r] = detail::sum_region_naively<Payload>(plan, r, value);
}

/// Down: totals[r] = sum of values[region_of[j]] over the particles j of region r; that is, for every
/// particle i, totals[region_of[i]] = sum of the values of all regions that hold i, each as often as it has
/// copies.
/// @pre  `values` and `totals` have one element per distinct region and do not overlap.
template <typename Payload>
void sum_down(const SumPlan& plan, std::span<const Payload> values, SumScratch<Payload>& scratch,
              std::span<Payload> totals) {
  SC_ASSERT(values.size() == plan.regions() && totals.size() == plan.regions(),
            "{} values and {} totals for {} regions", values.size(), totals.size(), plan.regions());
  SC_ASSERT(values.data() != totals.data(), "values and totals of {} regions overlap", plan.regions());
  detail::sum_lists(plan.regions_of_bar(), values.data(), scratch.bars.data());
  detail::sum_lists(plan.bars_of_plate(), scratch.bars.data(), scratch.plates.data());
  detail::sum_lists(plan.plates_of_region(), scratch.plates.data(), totals.data());
}

/// The same, without sharing.
template <typename Payload>
void sum_down_naively(const SumPlan& plan, std::span<const Payload> values, std::span<Payload> totals) {
  SC_ASSERT(values.size() == plan.regions() && totals.size() == plan.regions(),
            "{} values and {} totals for {} regions", values.size(), totals.size(), plan.regions());
  const auto value = [&](std::uint32_t particle) -> const Payload& {
    return values[plan.region_of()[particle]];
  };
  for (std::size_t r = 0; r < plan.regions(); ++r)
    totals[r] = detail::sum_region_naively<Payload>(plan, r, value);
}

}  // namespace softcell::ppu
