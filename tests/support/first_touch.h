#pragma once
// Where a moved sphere touches a mesh first, by its triangles alone: slow, and without anything that queries are answered with. In
// softcell_test_measures, as drawn_overlap.h.

#include <Eigen/Core>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::tests {

/// @return  the first share of the way, in 400 steps, at which a triangle is within the radius of the sphere's centre; beyond 1: none is
double first_touch(const ppu::TriangleMesh& mesh, const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                   double radius);

}  // namespace softcell::tests
