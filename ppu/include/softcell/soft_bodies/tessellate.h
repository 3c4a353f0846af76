#pragma once
// Divides the triangles of a coarse mesh. A soft body is drawn, and touches, with its triangles; its surface bends only at their vertices.
//
//     const auto model = make_soft_body_model(tessellate(mesh, settings.cell_size), settings);

#include <cstddef>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// The most triangles of a mesh that tessellate() returns.
inline constexpr std::size_t kMaxTessellatedTriangles = 2'000'000;

/// Returns the same shape with no edge longer than `longest_edge`: longer edges are halved until none is left. Edges as long as a cell
/// follow the lattice; shorter ones cost vertices without showing more.
///
/// The mesh's own vertices do not change and keep their numbers. New vertices in the middle of edges follow them and have the mean of both
/// ends' attributes. Triangles stay in their parts. Whether an edge is halved depends only on the positions of its ends, so all triangles
/// at an edge are divided alike: a closed mesh stays closed, also along seams with double vertices. Deterministic. Any thread.
/// @param longest_edge  metres, above 0
/// @throws std::invalid_argument  the length is not above 0 and finite; more than kMaxTessellatedTriangles would be needed; as validate()
TriangleMesh tessellate(const TriangleMesh& mesh, float longest_edge);

}  // namespace softcell::ppu
