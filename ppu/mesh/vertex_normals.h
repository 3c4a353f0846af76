#pragma once
// Vertex normals for a mesh that has none: smooth across an edge unless the surface bends sharply there.

#include <array>
#include <span>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// An edge is sharp when its faces' normals differ by more than 60 degrees.
inline constexpr double kCreaseCosine = 0.5;

/// Gives each position one normal for every group of its triangles that hang together across smooth edges; a
/// position on a crease becomes several vertices. An edge is smooth when exactly two triangles share it, wind
/// the same way round, and bend by less than the crease. Normals are weighted as in N. Max, "Weights for
/// Computing Vertex Normals from Facet Normals" (1999): exact on spheres, independent of how a flat part is
/// cut into triangles at right angles, and free of trigonometry.
/// @param positions  finite; no two equal (otherwise the seam between equal ones is sharp)
/// @param triangles  none degenerate: three different positions not on a line
/// @return  vertices in the order in which the triangles first name them; positions that no triangle uses are
/// left out.
TriangleMesh with_smooth_normals(std::span<const Eigen::Vector3f> positions,
                                 std::span<const std::array<std::uint32_t, 3>> triangles,
                                 double crease_cosine = kCreaseCosine);

/// Twice the area vector of a triangle; zero exactly when it is degenerate, within the rounding of a double.
Eigen::Vector3d area_vector(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c);

}  // namespace softcell::ppu
