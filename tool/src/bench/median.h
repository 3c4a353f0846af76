#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "softcell/base/assert.h"

namespace softcell::tool {

/// The middle of the values, or the mean of the two in the middle. @pre there is one, and they are sorted
inline double median_of(std::span<const double> sorted) {
  SC_ASSERT(!sorted.empty() && std::ranges::is_sorted(sorted), "the median of {} values", sorted.size());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 != 0 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

}  // namespace softcell::tool
