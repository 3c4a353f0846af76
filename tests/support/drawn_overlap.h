#pragma once
// How deep the drawn surfaces of soft bodies lie in each other, by their meshes alone: slow, and without anything that contacts are
// found with.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "softcell/soft_bodies/skinned_mesh.h"

namespace softcell::tests {

/// A deformed mesh. Parts of it may reach into each other.
class DrawnBody {
 public:
  explicit DrawnBody(const ppu::SoftBody<3>& body)
      : mesh_(body.model().mesh()),
        cell_(body.model().lattice().spacing),
        positions_(mesh_.positions.size()) {
    std::vector<Eigen::Vector3f> normals(positions_.size());
    ppu::skin(body, positions_, normals);
    for (const Eigen::Vector3f& position : positions_) box_.extend(position);
  }

  std::span<const Eigen::Vector3f> positions() const { return positions_; }
  const Eigen::AlignedBox3f& box() const { return box_; }
  float cell() const { return cell_; }

  /// Metres to the nearest triangle, of a point that a line along x finds inside; else 0. Where parts reach into each other that may be
  /// one that lies inside: less than how deep it is.
  float depth(const Eigen::Vector3f& point) const {
    // Off corners and edges, where modelled ones like to be.
    const Eigen::Vector3d p = point.cast<double>() + Eigen::Vector3d(0, 1.1e-6, 1.7e-6);
    int winding = 0;
    for (const auto& [i, j, k] : mesh_.triangles) {
      const Eigen::Vector3d a = positions_[i].cast<double>() - p, b = positions_[j].cast<double>() - p,
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

 private:
  static float distance(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                        const Eigen::Vector3f& c) {
    const Eigen::Vector3f normal = (b - a).cross(c - a);
    const auto is_left = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
      return normal.dot((to - from).cross(p - from)) >= 0;
    };
    if (normal.squaredNorm() > 0 && is_left(a, b) && is_left(b, c) && is_left(c, a))
      return std::abs(normal.normalized().dot(p - a));
    const auto from_line = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
      const Eigen::Vector3f along = to - from;
      const float length = along.squaredNorm();
      const float share = length > 0 ? std::clamp((p - from).dot(along) / length, 0.0f, 1.0f) : 0.0f;
      return (p - from - share * along).norm();
    };
    return std::min({from_line(a, b), from_line(b, c), from_line(c, a)});
  }

  const ppu::TriangleMesh& mesh_;
  float cell_;
  std::vector<Eigen::Vector3f> positions_;
  Eigen::AlignedBox3f box_;
};

/// The deepest vertex of one body in another one, in cells of the finer lattice.
inline float deepest(std::span<const DrawnBody> bodies) {
  float most = 0;
  for (const DrawnBody& body : bodies)
    for (const DrawnBody& other : bodies) {
      if (&body == &other || !body.box().intersects(other.box())) continue;
      for (const Eigen::Vector3f& position : body.positions())
        if (other.box().contains(position))
          most = std::max(most, other.depth(position) / std::min(body.cell(), other.cell()));
    }
  return most;
}

}  // namespace softcell::tests
