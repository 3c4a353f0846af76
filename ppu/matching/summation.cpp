#include "ppu/matching/summation.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

#include "ppu/numbers/hash_of_numbers.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

/// Numbers lists, and stores each once: equal lists get the same number, in the order of their first appearance.
class UniqueLists {
 public:
  std::uint32_t number_of(std::span<const std::uint32_t> list) {
    const std::uint64_t hash = HashOfNumbers()(list);
    const auto [first, last] = by_hash_.equal_range(hash);
    for (auto known = first; known != last; ++known)
      if (std::ranges::equal(lists_[known->second], list)) return known->second;
    const auto number = static_cast<std::uint32_t>(lists_.size());
    by_hash_.emplace(hash, number);
    lists_.push(list);
    return number;
  }

  Csr take() { return std::move(lists_); }

 private:
  Csr lists_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> by_hash_;
};

/// Needs one pass, because lists are ascending: each centre r = 0, 1, ... must be the next entry in the list of each member of r.
void check_symmetry(const Csr& regions) {
  std::vector<std::uint32_t> next(regions.offsets.begin(), regions.offsets.end() - 1);
  for (std::uint32_t r = 0; r < regions.size(); ++r)
    for (const std::uint32_t i : regions[r])
      if (i >= regions.size() || next[i] >= regions.offsets[i + 1] || regions.items[next[i]++] != r)
        throw std::invalid_argument("SumPlan: membership of regions is not symmetric");
}

/// Cuts a region into plates and bars, and numbers each.
class Cutter {
 public:
  explicit Cutter(std::span<const Eigen::Vector3i> particles) : particles_(particles) {}

  std::uint32_t add(std::span<const std::uint32_t> region) {
    SC_ASSERT(!region.empty(), "a region without particles");
    plate_list_.clear();
    for (std::size_t first = 0, last = 0; first < region.size(); first = last) {
      const int x = particles_[region[first]].x();
      while (last < region.size() && particles_[region[last]].x() == x) ++last;
      plate_list_.push_back(add_plate(region.subspan(first, last - first)));
    }
    return regions.number_of(plate_list_);
  }

  UniqueLists bars, plates, regions;

 private:
  std::uint32_t add_plate(std::span<const std::uint32_t> plate) {
    bar_list_.clear();
    for (std::size_t first = 0, last = 0; first < plate.size(); first = last) {
      const int y = particles_[plate[first]].y();
      while (last < plate.size() && particles_[plate[last]].y() == y) ++last;
      bar_list_.push_back(bars.number_of(plate.subspan(first, last - first)));
    }
    return plates.number_of(bar_list_);
  }

  std::span<const Eigen::Vector3i> particles_;
  std::vector<std::uint32_t> plate_list_, bar_list_;
};

}  // namespace

SumPlan::SumPlan(std::span<const Eigen::Vector3i> particles, const Csr& regions) {
  if (regions.size() != particles.size())
    throw std::invalid_argument("SumPlan: expected one region per particle");
  check_symmetry(regions);
  SC_ASSERT(std::ranges::is_sorted(particles,
                                   [](const auto& a, const auto& b) {
                                     return std::lexicographical_compare(a.begin(), a.end(), b.begin(),
                                                                         b.end());
                                   }),
            "{} particles are not sorted by x, y and z", particles.size());

  Cutter cutter(particles);
  region_of_.reserve(regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) region_of_.push_back(cutter.add(regions[r]));

  particles_of_bar_ = cutter.bars.take();
  bars_of_plate_ = cutter.plates.take();
  plates_of_region_ = cutter.regions.take();
  regions_of_bar_ = particles_of_bar_;
  for (std::uint32_t& item : regions_of_bar_.items) item = region_of_[item];
}

std::vector<std::uint32_t> SumPlan::members(std::size_t region) const {
  SC_ASSERT(region < regions(), "region {} of {}", region, regions());
  std::vector<std::uint32_t> members;
  for (const std::uint32_t plate : plates_of_region_[region])
    for (const std::uint32_t bar : bars_of_plate_[plate])
      for (const std::uint32_t particle : particles_of_bar_[bar]) members.push_back(particle);
  return members;
}

}  // namespace softcell::ppu
