#pragma once
// The surface of a mesh whose parts reach into each other.

#include <optional>

#include "ppu/mesh/solid.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// The surface of what is inside: the mesh without what lies within other parts of it. Triangles of which a part is
/// within are cut into smaller ones, to an eighth of `cell`. Three positions for each triangle, with its normal; no attributes.
/// @param solid  of the mesh
/// @param cell   metres, above 0: what is smaller than a thousandth of it does not count
/// @return none: next to nothing lies within other parts, or the mesh is open. It is its own surface
std::optional<TriangleMesh> outer_surface(const TriangleMesh& mesh, const Solid& solid, float cell);

}  // namespace softcell::ppu
