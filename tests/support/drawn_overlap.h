#pragma once
// How deep the drawn surfaces of soft bodies lie in each other, by their meshes alone: slow, and without anything that contacts are
// found with. In a library of its own (softcell_test_measures), which is optimised and has no sanitizer in any build.

#include <Eigen/Geometry>
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
  float depth(const Eigen::Vector3f& point) const;

 private:
  const ppu::TriangleMesh& mesh_;
  float cell_;
  std::vector<Eigen::Vector3f> positions_;
  Eigen::AlignedBox3f box_;
};

/// The deepest vertex of one body in another one, in cells of the finer lattice.
float deepest(std::span<const DrawnBody> bodies);

}  // namespace softcell::tests
