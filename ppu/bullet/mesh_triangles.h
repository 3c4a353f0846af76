#pragma once
// Reads the triangles of Bullet's concave shapes.

#include <BulletCollision/CollisionShapes/btConcaveShape.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// Appends the triangles in a box, in the order of processAllTriangles().
/// @param box  in the shape's frame, as are the triangles
void find_triangles(const btConcaveShape& shape, const Bounds<3>& box,
                    std::vector<std::array<Eigen::Vector3f, 3>>& triangles);

}  // namespace softcell::ppu
