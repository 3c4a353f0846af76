#pragma once
// Tells whether a triangle and a cube touch.

#include <Eigen/Core>
#include <array>

namespace softcell::ppu {

/// True if the triangle and the cube with the given centre and half edge have a point in common; touching counts. By separating axes: three
/// box normals, the triangle's normal, nine cross products of edges. In double precision, in which products of float coordinates do not
/// round.
/// @source  [AM01]
bool triangle_touches_cube(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& centre,
                           double half_edge);

}  // namespace softcell::ppu
