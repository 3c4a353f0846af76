#include "ppu/lattice/triangle_box.h"

#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

using Eigen::Vector3d;

Vector3d cross(const Vector3d& a, const Vector3d& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

double dot(const Vector3d& a, const Vector3d& b) { return a.x() * b.x() + a.y() * b.y() + a.z() * b.z(); }

/// Whether the projections of the triangle and of the cube about 0 on this axis are disjoint. A zero axis separates nothing.
bool separates(const Vector3d& axis, const std::array<Vector3d, 3>& triangle, double half_edge) {
  const double p0 = dot(axis, triangle[0]), p1 = dot(axis, triangle[1]), p2 = dot(axis, triangle[2]);
  const double radius = half_edge * (std::abs(axis.x()) + std::abs(axis.y()) + std::abs(axis.z()));
  return std::min({p0, p1, p2}) > radius || std::max({p0, p1, p2}) < -radius;
}

}  // namespace

bool triangle_touches_cube(const std::array<Vector3d, 3>& triangle, const Vector3d& centre,
                           double half_edge) {
  SC_ASSERT(half_edge > 0, "a cube with half an edge of {}", half_edge);
  const std::array<Vector3d, 3> t{triangle[0] - centre, triangle[1] - centre, triangle[2] - centre};
  const std::array<Vector3d, 3> edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  const std::array<Vector3d, 3> normals{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (const Vector3d& normal : normals)
    if (separates(normal, t, half_edge)) return false;
  if (separates(cross(edges[0], edges[1]), t, half_edge)) return false;
  for (const Vector3d& edge : edges)
    for (const Vector3d& normal : normals)
      if (separates(cross(normal, edge), t, half_edge)) return false;
  return true;
}

}  // namespace softcell::ppu
