#pragma once
// The middle one of measurements.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace softcell {

/// @pre there is one
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace softcell
