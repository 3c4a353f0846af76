#pragma once
// Finer triangles for a coarse mesh: a soft body is drawn and touches with its triangles, and these bend at their vertices only.
//
//     const auto model = make_soft_body_model(tessellate(mesh, settings.cell_size), settings);

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// The same shape with edges of at most a length: longer ones are halved until none is. About the edge of a cell follows a lattice; more
/// costs more vertices and shows nothing.
///
/// The mesh's own vertices stay as they are and keep their numbers; those in the middle of edges come behind them, with the mean of both
/// ends' attributes. Triangles stay in their parts. An edge is halved by where its ends are, alike in all triangles that have it: a closed
/// mesh stays closed, also along seams where vertices are there twice. Deterministic.
/// @param longest_edge  metres, above 0
/// @throws std::invalid_argument  the length is not above 0 and finite; more than kMaxTessellatedTriangles would be needed; as validate()
TriangleMesh tessellate(const TriangleMesh& mesh, float longest_edge);

inline constexpr std::size_t kMaxTessellatedTriangles = 2'000'000;

}  // namespace softcell::ppu
