#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

namespace softcell::ppu {

/// Whether the line between two places meets a box, its sides included; a little outside counts as well, as both are rounded. However long
/// the line is.
/// @tparam Box  has `low` and `high`, as Bounds
template <int kDimension, class Box>
bool meets(const Eigen::Vector<float, kDimension>& from, const Eigen::Vector<float, kDimension>& to,
           const Box& box) {
  constexpr double kWider = 1e-6;  // of what is far or large
  double first = 0, last = 1;      // shares of the line
  for (int d = 0; d < kDimension; ++d) {
    const double begin = static_cast<double>(from[d]), way = static_cast<double>(to[d]) - begin;
    const double side = kWider * static_cast<double>(std::max(std::abs(box.low[d]), std::abs(box.high[d])));
    const double low = static_cast<double>(box.low[d]) - side, high = static_cast<double>(box.high[d]) + side;
    if (way == 0) {
      if (begin < low || begin > high) return false;
      continue;
    }
    double enters = (low - begin) / way, leaves = (high - begin) / way;
    if (enters > leaves) std::swap(enters, leaves);
    first = std::max(first, enters);
    last = std::min(last, leaves);
  }
  return first <= last;
}

}  // namespace softcell::ppu
