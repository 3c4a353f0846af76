#pragma once
// Where a line along the x axis goes through a triangle. Of two triangles with a common edge, a line through this edge meets one; at a fold
// it meets both, from opposite sides, or neither.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// Twice the area of the triangle a, b and a line along x, as seen against x: above 0 if the line is left of the way from a to b. The way
/// from b to a gives exactly the negative, however it is rounded: both triangles of an edge agree on which of them a line meets.
inline double area_beside(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double y, double z) {
  const bool swapped = std::pair(b.y(), b.z()) < std::pair(a.y(), a.z());
  const Eigen::Vector3d &from = swapped ? b : a, &to = swapped ? a : b;
  const double area = (to.y() - from.y()) * (z - from.z()) - (to.z() - from.z()) * (y - from.y());
  return swapped ? -area : area;
}

/// How often the edges of a triangle go round a line along x: 1 counterclockwise as seen against x, -1 clockwise; 0: the line misses it.
inline int turns_around(const std::array<Eigen::Vector3d, 3>& triangle, double y, double z) {
  int sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = triangle[k], &b = triangle[(k + 1) % 3];
    const bool a_is_above = a.z() > z, b_is_above = b.z() > z;
    if (a_is_above == b_is_above) continue;
    const double area = area_beside(a, b, y, z);
    if (b_is_above && area > 0) ++sum;
    if (a_is_above && area < 0) --sum;
  }
  return sum;
}

/// The x at which the line meets the triangle's plane. @pre turns_around() it is not 0
inline double place_in(const std::array<Eigen::Vector3d, 3>& triangle, double y, double z) {
  const Eigen::Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  SC_ASSERT(normal.x() != 0, "a line along x at y = {}, z = {} is in a triangle's plane", y, z);
  return triangle[0].x() -
         (normal.y() * (y - triangle[0].y()) + normal.z() * (z - triangle[0].z())) / normal.x();
}

}  // namespace softcell::ppu
