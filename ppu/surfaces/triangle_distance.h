#pragma once
// Measures how far a point is from the surface of a mesh, and on which side.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// The point of the triangle that is nearest to `point`.  [Eri05, 5.1.5] In single precision its error may be the rounding error of the
/// triangle's longest side, times the ratio of that side to the height upon it.
template <typename Real>
Eigen::Vector3<Real> nearest_point(const std::array<Eigen::Vector3<Real>, 3>& triangle,
                                   const Eigen::Vector3<Real>& point) {
  const auto& [a, b, c] = triangle;
  using Vector = Eigen::Vector3<Real>;
  const Vector ab = b - a, ac = c - a, ap = point - a;
  const Real d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vector bp = point - b;
  const Real d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const Real vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vector cp = point - c;
  const Real d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const Real vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const Real va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const Real scale = 1 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}
// Instantiated once, in triangle_distance.cpp: tests with sanitizers are compiled without optimisation, and the linker would take their
// copies.
extern template Eigen::Vector3f nearest_point(const std::array<Eigen::Vector3f, 3>&, const Eigen::Vector3f&);
extern template Eigen::Vector3d nearest_point(const std::array<Eigen::Vector3d, 3>&, const Eigen::Vector3d&);

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

  /// A sphere around a triangle. Most triangles need no closer look: their spheres are farther away than the nearest triangle.
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
