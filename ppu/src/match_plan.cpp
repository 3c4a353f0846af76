#include "softcell/ppu/match_plan.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <string>

#include "sum_list.h"

namespace softcell::ppu {

namespace {

using spu::groups_of;

/// Where a bar, plate or region stands in the order in which sums are made.
struct Station {
  std::array<int, 3> row{};
  int place = 0;
  bool known = false;

  auto key() const { return std::pair(row, place); }
};

/// The stations of all bars, plates and regions, by the region in which they first appear: bars follow one
/// another along z, plates along y, regions along x.
struct Stations {
  std::vector<Station> bars, plates, regions;

  Stations(const Lattice& lattice, const SumPlan& sums)
      : bars(sums.particles_of_bar().size()), plates(sums.bars_of_plate().size()), regions(sums.regions()) {
    for (std::size_t i = 0; i < sums.particles(); ++i) {
      const std::uint32_t r = sums.region_of()[i];
      if (regions[r].known) continue;
      const Eigen::Vector3i& centre = lattice.particles[i];
      regions[r] = {{centre.y(), centre.z(), 0}, centre.x(), true};
      for (const std::uint32_t p : sums.plates_of_region()[r]) {
        const int x = first_particle(lattice, sums, p).x();
        if (!plates[p].known) plates[p] = {{x, centre.z(), 0}, centre.y(), true};
        for (const std::uint32_t b : sums.bars_of_plate()[p]) {
          const int y = lattice.particles[sums.particles_of_bar()[b][0]].y();
          if (!bars[b].known) bars[b] = {{x, y, 0}, centre.z(), true};
        }
      }
    }
  }

 private:
  static const Eigen::Vector3i& first_particle(const Lattice& lattice, const SumPlan& sums,
                                               std::uint32_t plate) {
    return lattice.particles[sums.particles_of_bar()[sums.bars_of_plate()[plate][0]][0]];
  }
};

/// An order of things, and the slot that each gets by it: 1, 2, 3, ...
struct Order {
  std::vector<std::uint32_t> item;  // by rank
  std::vector<std::uint32_t> slot;  // by item

  explicit Order(const std::vector<Station>& stations) : item(stations.size()), slot(stations.size()) {
    std::iota(item.begin(), item.end(), 0u);
    std::stable_sort(item.begin(), item.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return stations[a].key() < stations[b].key(); });
    for (std::uint32_t rank = 0; rank < item.size(); ++rank) slot[item[rank]] = rank + 1;
  }
};

template <typename SlotOf>
SumList list_of(const Csr& lists, const std::vector<Station>& stations, const Order& order,
                const SlotOf& slot_of, std::size_t padding = 0) {
  std::vector<Sum> sums;
  for (const std::uint32_t item : order.item) {
    Sum sum{stations[item].row, stations[item].place, {}};
    for (const std::uint32_t term : lists[item]) sum.terms.push_back(slot_of(term));
    std::ranges::sort(sum.terms);
    sums.push_back(std::move(sum));
  }
  for (std::size_t i = 0; i < padding; ++i) sums.push_back({{}, 0, {0}});
  return write_sum_list(sums, MatchPlan::kRestart);
}

spu::MatchParticles particles_at(const MatchingPlan<float>& matching, std::size_t first,
                                 std::span<const std::uint32_t> region_of) {
  spu::MatchParticles group{};
  for (std::size_t lane = 0; lane < 4 && first + lane < matching.particles(); ++lane) {
    const auto& particle = matching.particle_constants()[first + lane];
    for (int d = 0; d < 3; ++d) group.rest_moment[lane][d] = particle.modified_mass * particle.x0[d];
    group.rest_moment[lane][3] = particle.modified_mass;
    group.inverse_mass[lane] = 1 / particle.mass;
    group.mass[lane] = particle.mass;
    group.region[lane] = (region_of[first + lane] + 1) * (spu::kMatchSlotBytes / spu::kMatchOffsetUnit);
  }
  return group;
}

spu::MatchRegions regions_at(const MatchingPlan<float>& matching, std::size_t first, const Order& order) {
  spu::MatchRegions group{};
  for (std::size_t lane = 0; lane < 4 && first + lane < order.item.size(); ++lane) {
    const auto& region = matching.region_constants()[order.item[first + lane]];
    group.centre_x[lane] = region.c0.x();
    group.centre_y[lane] = region.c0.y();
    group.centre_z[lane] = region.c0.z();
    group.inverse_mass[lane] = region.inverse_mass;
  }
  return group;
}

/// Parts of a plan one behind the other, each on a multiple of 16 bytes.
class Writer {
 public:
  Writer() : bytes_(sizeof(spu::MatchPlanHeader)) {}

  template <typename T>
  std::uint32_t append(const std::vector<T>& items) {
    bytes_.resize((bytes_.size() + 15) / 16 * 16);
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + items.size() * sizeof(T));
    std::memcpy(bytes_.data() + offset, items.data(), items.size() * sizeof(T));
    return static_cast<std::uint32_t>(offset);
  }

  std::vector<std::byte> bytes_;
};

/// The power of two at or below the spacing.
float grid_of(float spacing) {
  int exponent = 0;
  std::frexp(spacing, &exponent);
  return std::ldexp(1.0f, exponent - 1);
}

float inverse_mass_of(const MatchingPlan<float>& matching) {
  double mass = 0;
  for (const auto& particle : matching.particle_constants()) mass += static_cast<double>(particle.mass);
  return static_cast<float>(1 / mass);
}

void check_size(std::size_t particles, std::size_t slots, std::uint64_t bytes) {
  if (slots <= kMaxSumSlot && bytes <= spu::kMatchArenaBytes) return;
  throw BodyTooLarge("a soft body of " + std::to_string(particles) + " particles needs " +
                     std::to_string(bytes) + " bytes of local store; the kernel match has " +
                     std::to_string(spu::kMatchArenaBytes));
}

}  // namespace

MatchPlan::MatchPlan(const Lattice& lattice, const MatchingPlan<float>& matching) {
  const SumPlan& sums = matching.sums();
  const Stations stations(lattice, sums);
  const Order bars(stations.bars), plates(stations.plates), regions(stations.regions);
  for (const std::uint32_t r : sums.region_of()) region_of_.push_back(regions.slot[r] - 1);

  const std::size_t particle_groups = (matching.particles() + 3) / 4,
                    region_groups = (sums.regions() + 3) / 4;
  const std::size_t slots =
      1 + std::max({4 * particle_groups, bars.item.size(), plates.item.size(), 4 * region_groups});
  // Before lists are written, whose offsets would not fit: what state and buffers need at least.
  check_size(matching.particles(), slots, std::uint64_t{slots} * 2 * spu::kMatchSlotBytes);

  std::vector<spu::MatchParticles> particle_constants;
  for (std::size_t i = 0; i < matching.particles(); i += 4)
    particle_constants.push_back(particles_at(matching, i, region_of_));
  std::vector<spu::MatchRegions> region_constants;
  for (std::size_t r = 0; r < sums.regions(); r += 4)
    region_constants.push_back(regions_at(matching, r, regions));

  const auto particle_slot = [](std::uint32_t i) { return i + 1; };
  const auto region_slot = [&](std::uint32_t r) { return regions.slot[r]; };
  const auto bar_slot = [&](std::uint32_t b) { return bars.slot[b]; };
  const auto plate_slot = [&](std::uint32_t p) { return plates.slot[p]; };
  const SumList from_particles = list_of(sums.particles_of_bar(), stations.bars, bars, particle_slot);
  const SumList from_regions = list_of(sums.regions_of_bar(), stations.bars, bars, region_slot);
  const SumList of_plates = list_of(sums.bars_of_plate(), stations.plates, plates, bar_slot);
  const SumList of_regions = list_of(sums.plates_of_region(), stations.regions, regions, plate_slot,
                                     4 * region_groups - sums.regions());
  additions_ = from_particles.additions + of_plates.additions + of_regions.additions;

  Writer writer;
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
  header.grid = grid_of(lattice.spacing);
  header.inverse_mass = inverse_mass_of(matching);

  lines_.resize((writer.bytes_.size() + sizeof(Line) - 1) / sizeof(Line));
  header.bytes = static_cast<std::uint32_t>(lines_.size() * sizeof(Line));
  check_size(matching.particles(), slots, spu::match_local_store_bytes(header));
  std::memcpy(writer.bytes_.data(), &header, sizeof header);
  std::memcpy(lines_.data(), writer.bytes_.data(), writer.bytes_.size());
}

const spu::MatchPlanHeader& MatchPlan::header() const {
  return *reinterpret_cast<const spu::MatchPlanHeader*>(lines_.data());
}

std::span<const std::byte> MatchPlan::bytes() const { return std::as_bytes(std::span(lines_)); }

}  // namespace softcell::ppu
