#pragma once
// How far a point is from the surface of a mesh, and on which side.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// The point of the triangle that is nearest to `point`.  [Eri05, 5.1.5]
Eigen::Vector3f nearest_point(const std::array<Eigen::Vector3f, 3>& triangle, const Eigen::Vector3f& point);

/// Finds the triangles near a point by a grid of cubes.
class TriangleGrid {
 public:
  /// @param cube_edge  metres, above 0
  TriangleGrid(const TriangleMesh& mesh, float cube_edge);

  /// The distance to the nearest triangle, negative behind it, in metres. Where several triangles are equally
  /// near, at edges and corners, the one that the point faces most squarely decides about the side.
  /// @param reach  metres; beyond it the result is `reach`, with an unknown side
  float signed_distance(const Eigen::Vector3f& point, float reach) const;

 private:
  struct Nearest;
  void look_at_cube(const Eigen::Vector3i& cube, const Eigen::Vector3f& point, Nearest& nearest) const;
  Eigen::Vector3i cube_of(const Eigen::Vector3f& point) const;

  /// Around a triangle: most triangles are farther away than the nearest one by more than its radius.
  struct Sphere {
    float x, y, z, radius;
  };
  std::vector<std::array<Eigen::Vector3f, 3>> triangles_;
  std::vector<Sphere> spheres_;  // of each triangle
  float edge_;
  Eigen::Vector3f low_;
  Eigen::Vector3i counts_;
  std::vector<std::uint32_t> begin_, items_;  // of each cube: its triangles
};

}  // namespace softcell::ppu
