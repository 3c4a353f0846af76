#pragma once
// Do a triangle and a box touch?

#include <Eigen/Core>
#include <array>

namespace softcell::ppu {

/// True when the triangle and the cube with the given centre and half edge have a point in common; touching
/// counts. By separating axes: three box normals, the triangle's normal, nine cross products of edges. In
/// double precision, where the coordinates of a mesh in float and of its grid leave room for every product.
/// @source  [AM01]
bool triangle_touches_cube(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& centre,
                           double half_edge);

}  // namespace softcell::ppu
