#pragma once
// Samples an edge of an obstacle within a box.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ppu/surfaces/way_in_box.h"

namespace softcell::ppu {

/// Distance between samples of an obstacle's edges, in cells.
inline constexpr float kEdgeSpacing = 0.5f;

/// Samples the edge from `from` to `from + along` at most every `spacing` metres and calls work(point, share) for the points in the box,
/// and perhaps for a few beside it. If the edge is no longer than `spacing`, its two ends are the samples. The points do not move along the
/// edge when the box moves. `share` is the fraction of the way from `from` to the point, 0..1.
template <typename Work>
void for_each_point_of_edge(const Eigen::Vector3f& from, const Eigen::Vector3f& along, const Bounds<3>& box,
                            float spacing, const Work& work) {
  constexpr double kMostPoints = 1e4;  // in a body that is stretched far
  const auto [first, last] = way_in_box(box, from, along);
  if (first > last) return;
  const float length = along.norm();
  if (!(length > spacing)) {
    work(from, 0.0f);
    work(from + along, 1.0f);
    return;
  }
  const double step = double{spacing} / double{length};
  const double begin = std::ceil(double{first} / step);
  const int count = static_cast<int>(std::min(kMostPoints, std::floor(double{last} / step) - begin + 1));
  for (int i = 0; i < count; ++i) {
    const float share = static_cast<float>((begin + i) * step);
    work(from + share * along, share);
  }
  if (last == 1) work(from + along, 1.0f);
}

}  // namespace softcell::ppu
