#pragma once
// The order in which a plan makes its sums: neighbours along a row of the lattice come one after the other, so that a sum list can make
// each from the one before it.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "ppu/matching/summation.h"
#include "ppu/plans/sum_list.h"

namespace softcell::ppu {

/// The position of a bar, plate or region in that order.
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

  /// @param particles  grid indices from which `sums` was made.
  Stations(std::span<const Eigen::Vector3i> particles, const SumPlan& sums);
};

/// An order of items, and the slot that it gives each: 1, 2, 3, ...
struct Order {
  std::vector<std::uint32_t> item;  ///< by rank
  std::vector<std::uint32_t> slot;  ///< by item

  explicit Order(const std::vector<Station>& stations);
};

/// All items in their order, followed by `padding` sums of nothing.
/// @param terms    of an item: its terms
/// @param slot_of  the slot of a term
std::vector<Sum> ordered_sums(const std::vector<Station>& stations, const Order& order,
                              const std::function<std::span<const std::uint32_t>(std::uint32_t)>& terms,
                              const std::function<std::uint32_t(std::uint32_t)>& slot_of,
                              std::size_t padding = 0);

/// The sum list that makes these sums.
inline SumList ordered_sum_list(const std::vector<Station>& stations, const Order& order,
                                const std::function<std::span<const std::uint32_t>(std::uint32_t)>& terms,
                                const std::function<std::uint32_t(std::uint32_t)>& slot_of,
                                const SumListFormat& format, std::size_t padding = 0) {
  return write_sum_list(ordered_sums(stations, order, terms, slot_of, padding), format);
}

}  // namespace softcell::ppu
