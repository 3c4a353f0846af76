#include "support/drawn_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace softcell::tests {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

/// The distance from a point to a triangle.
float distance(const Vector3f& p, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const Vector3f normal = (b - a).cross(c - a);
  const auto is_left = [&](const Vector3f& from, const Vector3f& to) {
    return normal.dot((to - from).cross(p - from)) >= 0;
  };
  if (normal.squaredNorm() > 0 && is_left(a, b) && is_left(b, c) && is_left(c, a))
    return std::abs(normal.normalized().dot(p - a));
  const auto from_line = [&](const Vector3f& from, const Vector3f& to) {
    const Vector3f along = to - from;
    const float length = along.squaredNorm();
    const float share = length > 0 ? std::clamp((p - from).dot(along) / length, 0.0f, 1.0f) : 0.0f;
    return (p - from - share * along).norm();
  };
  return std::min({from_line(a, b), from_line(b, c), from_line(c, a)});
}

}  // namespace

float DrawnBody::depth(const Vector3f& point) const {
  // Off corners and edges, where modelled ones like to be.
  const Vector3d p = point.cast<double>() + Vector3d(0, 1.1e-6, 1.7e-6);
  int winding = 0;
  for (const auto& [i, j, k] : mesh_.triangles) {
    const Vector3d a = positions_[i].cast<double>() - p, b = positions_[j].cast<double>() - p,
                   c = positions_[k].cast<double>() - p;
    const double ab = a.y() * b.z() - a.z() * b.y(), bc = b.y() * c.z() - b.z() * c.y(),
                 ca = c.y() * a.z() - c.z() * a.y();
    const bool left = ab > 0 && bc > 0 && ca > 0, right = ab < 0 && bc < 0 && ca < 0;
    if ((left || right) && (bc * a.x() + ca * b.x() + ab * c.x()) / (ab + bc + ca) > 0)
      winding += left ? 1 : -1;
  }
  if (winding == 0) return 0;
  float nearest = std::numeric_limits<float>::max();
  for (const auto& [i, j, k] : mesh_.triangles)
    nearest = std::min(nearest, distance(point, positions_[i], positions_[j], positions_[k]));
  return nearest;
}

float deepest(std::span<const DrawnBody> bodies) {
  float most = 0;
  for (const DrawnBody& body : bodies)
    for (const DrawnBody& other : bodies) {
      if (&body == &other || !body.box().intersects(other.box())) continue;
      for (const Vector3f& position : body.positions())
        if (other.box().contains(position))
          most = std::max(most, other.depth(position) / std::min(body.cell(), other.cell()));
    }
  return most;
}

}  // namespace softcell::tests
