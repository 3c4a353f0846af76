#pragma once
// The part of a line segment that lies in a box.

#include <Eigen/Core>
#include <algorithm>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// The part of a segment in a box, from `first` to `last`, as fractions of the segment, 0..1. If `first` is larger, no part is in the box.
struct WayInBox {
  float first = 0, last = 1;
};

/// @param along  from the segment's begin to its end
template <int kDimension>
WayInBox way_in_box(const Bounds<kDimension>& box, const Eigen::Vector<float, kDimension>& from,
                    const Eigen::Vector<float, kDimension>& along) {
  WayInBox part;
  for (int d = 0; d < kDimension; ++d) {
    const float low = box.low[d] - from[d], high = box.high[d] - from[d];
    if (along[d] == 0) {
      if (low > 0 || high < 0) return {1, 0};
      continue;
    }
    part.first = std::max(part.first, (along[d] > 0 ? low : high) / along[d]);
    part.last = std::min(part.last, (along[d] > 0 ? high : low) / along[d]);
  }
  return part;
}

/// Tolerates rounding: it must not part two boxes that share a side.
inline bool is_any(const WayInBox& part) { return part.first <= part.last + 1e-6f; }

}  // namespace softcell::ppu
