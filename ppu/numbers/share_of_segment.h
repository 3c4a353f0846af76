#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace softcell::ppu {

/// The fraction of a segment, 0..1, from its begin to its nearest place to `point`.
/// @param along  from the segment's begin to its end; may be 0
inline float share_of_segment(const Eigen::Vector2f& from, const Eigen::Vector2f& along,
                              const Eigen::Vector2f& point) {
  const float square = along.squaredNorm();
  return square > 0 ? std::clamp(along.dot(point - from) / square, 0.0f, 1.0f) : 0.0f;
}

}  // namespace softcell::ppu
