#include "ppu/plans/sum_order.h"

#include <algorithm>
#include <numeric>

#include "softcell/base/assert.h"

namespace softcell::ppu {

Stations::Stations(std::span<const Eigen::Vector3i> particles, const SumPlan& sums)
    : bars(sums.particles_of_bar().size()), plates(sums.bars_of_plate().size()), regions(sums.regions()) {
  SC_ASSERT(particles.size() == sums.particles(), "{} particles, sums of {}", particles.size(),
            sums.particles());
  const auto first_of_bar = [&](std::uint32_t b) { return particles[sums.particles_of_bar()[b][0]]; };
  for (std::size_t i = 0; i < sums.particles(); ++i) {
    const std::uint32_t r = sums.region_of()[i];
    if (regions[r].known) continue;
    const Eigen::Vector3i& centre = particles[i];
    regions[r] = {{centre.y(), centre.z(), 0}, centre.x(), true};
    for (const std::uint32_t p : sums.plates_of_region()[r]) {
      const int x = first_of_bar(sums.bars_of_plate()[p][0]).x();
      if (!plates[p].known) plates[p] = {{x, centre.z(), 0}, centre.y(), true};
      for (const std::uint32_t b : sums.bars_of_plate()[p]) {
        const int y = first_of_bar(b).y();
        if (!bars[b].known) bars[b] = {{x, y, 0}, centre.z(), true};
      }
    }
  }
}

Order::Order(const std::vector<Station>& stations) : item(stations.size()), slot(stations.size()) {
  std::iota(item.begin(), item.end(), 0u);
  std::stable_sort(item.begin(), item.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return stations[a].key() < stations[b].key(); });
  for (std::uint32_t rank = 0; rank < item.size(); ++rank) slot[item[rank]] = rank + 1;
}

std::vector<Sum> ordered_sums(const std::vector<Station>& stations, const Order& order,
                              const std::function<std::span<const std::uint32_t>(std::uint32_t)>& terms,
                              const std::function<std::uint32_t(std::uint32_t)>& slot_of,
                              std::size_t padding) {
  SC_ASSERT(order.item.size() == stations.size(), "an order of {} in {} stations", order.item.size(),
            stations.size());
  std::vector<Sum> sums;
  for (const std::uint32_t item : order.item) {
    SC_ASSERT(stations[item].known, "item {} of {} is in no region", item, stations.size());
    Sum sum{stations[item].row, stations[item].place, {}};
    for (const std::uint32_t term : terms(item)) sum.terms.push_back(slot_of(term));
    std::ranges::sort(sum.terms);
    sums.push_back(std::move(sum));
  }
  for (std::size_t i = 0; i < padding; ++i) sums.push_back({{}, 0, {0}});
  return sums;
}

}  // namespace softcell::ppu
