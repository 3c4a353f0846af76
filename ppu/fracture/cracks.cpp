#include "ppu/fracture/cracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// Each cell in which nothing of the body lies goes with the neighbour from which it is reached first, beginning with cells in which
/// something does: no piece is without anything to be seen.
void hold_empty_cells(const CellMesh& whole, Cracks& cracks) {
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> neighbours(cracks.cell_of_whole.size());
  for (std::uint32_t f = 0; f < cracks.faces.size(); ++f) {
    neighbours[cracks.faces[f].low].emplace_back(cracks.faces[f].high, f);
    neighbours[cracks.faces[f].high].emplace_back(cracks.faces[f].low, f);
  }
  std::vector<std::uint32_t> reached;
  std::vector<bool> is_reached(neighbours.size());
  for (std::uint32_t c = 0; c < neighbours.size(); ++c) {
    if (whole.is_empty(c)) continue;
    is_reached[c] = true;
    reached.push_back(c);
  }
  for (std::size_t next = 0; next < reached.size(); ++next)
    for (const auto& [cell, face] : neighbours[reached[next]]) {
      if (is_reached[cell]) continue;
      is_reached[cell] = true;
      reached.push_back(cell);
      cracks.strength[face] = std::numeric_limits<float>::infinity();
    }
}

}  // namespace

Cracks no_cracks(const TriangleMesh* mesh, const Lattice<3>& lattice, std::span<const float> strengths) {
  SC_ASSERT(strengths.empty() || strengths.size() == lattice.cells.size(), "{} strengths of {} cells",
            strengths.size(), lattice.cells.size());
  Cracks cracks;
  if (mesh != nullptr && !mesh->triangles.empty())
    cracks.whole = std::make_shared<const CellMesh>(*mesh, lattice);
  for (std::uint32_t c = 0; c < lattice.cells.size(); ++c) cracks.cell_of_whole.push_back(c);
  cracks.faces = faces_of(lattice);
  cracks.is_broken.resize(cracks.faces.size());
  for (const CellFace& face : cracks.faces)
    cracks.strength.push_back(strengths.empty() ? 1 : std::min(strengths[face.low], strengths[face.high]));
  if (cracks.whole) hold_empty_cells(*cracks.whole, cracks);
  return cracks;
}

std::vector<CrackedPiece> break_faces(const Lattice<3>& lattice, const Cracks& cracks,
                                      std::span<const std::uint32_t> faces) {
  std::vector<bool> broken = cracks.is_broken;
  for (const std::uint32_t face : faces) {
    SC_ASSERT(face < broken.size(), "face {} of {} breaks", face, broken.size());
    if (std::isfinite(cracks.strength[face])) broken[face] = true;
  }
  std::vector<std::uint32_t> face_at(3 * lattice.cells.size());  // of 3 low cell + axis
  for (std::uint32_t f = 0; f < cracks.faces.size(); ++f)
    face_at[3 * cracks.faces[f].low + cracks.faces[f].axis] = f;

  std::vector<CrackedPiece> pieces;
  for (LatticePiece& part : split(lattice, cracks.faces, broken)) {
    CrackedPiece& piece = pieces.emplace_back();
    piece.cracks.whole = cracks.whole;
    for (const std::uint32_t cell : part.cell_of)
      piece.cracks.cell_of_whole.push_back(cracks.cell_of_whole[cell]);
    piece.cracks.faces = faces_of(part.lattice);
    for (const CellFace& face : piece.cracks.faces) {
      const std::uint32_t old = face_at[3 * part.cell_of[face.low] + face.axis];
      piece.cracks.is_broken.push_back(broken[old]);
      piece.cracks.strength.push_back(cracks.strength[old]);
    }
    // With as many cells and particles as before nothing has come apart, and nothing else is drawn.
    const bool opens = part.lattice.cells.size() != lattice.cells.size() ||
                       part.lattice.particles.size() != lattice.particles.size();
    if (cracks.whole && opens) {
      piece.mesh = mesh_of_piece(*cracks.whole, part.lattice, piece.cracks.cell_of_whole, piece.cracks.faces);
      piece.cracks.open = std::move(piece.mesh.open);
    } else {
      piece.cracks.open = cracks.open;
    }
    piece.part = std::move(part);
  }
  return pieces;
}

}  // namespace softcell::ppu
