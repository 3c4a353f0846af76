#include "ppu/fracture/cracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// Makes unbreakable the faces that attach empty cells. Each empty cell stays with the neighbour from which a search reaches it first,
/// starting at cells that contain something of the body. So no piece is invisible.
void hold_empty_cells(const CellMesh& whole, BreakableFaces& cracks) {
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

template <int kDimension>
void take_all_faces(const Lattice<kDimension>& lattice, std::span<const float> strengths,
                    BreakableFaces& cracks) {
  SC_ASSERT(strengths.empty() || strengths.size() == lattice.cells.size(), "{} strengths of {} cells",
            strengths.size(), lattice.cells.size());
  for (std::uint32_t c = 0; c < lattice.cells.size(); ++c) cracks.cell_of_whole.push_back(c);
  cracks.faces = faces_of(lattice);
  cracks.is_broken.resize(cracks.faces.size());
  for (const CellFace& face : cracks.faces)
    cracks.strength.push_back(strengths.empty() ? 1 : std::min(strengths[face.low], strengths[face.high]));
}

/// Copies the state of a piece's faces from the body that it comes from.
/// @param broken  for each face of that body
template <int kDimension>
void take_faces_of_piece(const LatticePiece<kDimension>& part, const BreakableFaces& of,
                         const std::vector<bool>& broken, std::span<const std::uint32_t> face_at,
                         BreakableFaces& cracks) {
  for (const std::uint32_t cell : part.cell_of) cracks.cell_of_whole.push_back(of.cell_of_whole[cell]);
  cracks.faces = faces_of(part.lattice);
  for (const CellFace& face : cracks.faces) {
    const std::uint32_t old = face_at[kDimension * part.cell_of[face.low] + face.axis];
    cracks.is_broken.push_back(broken[old]);
    cracks.strength.push_back(of.strength[old]);
  }
}

/// Makes the piece's mesh. A piece with as many cells and particles as before has not come apart, so its mesh stays the same.
void draw_piece(const Lattice<3>& lattice, const Cracks<3>& cracks, CrackedPiece<3>& piece) {
  piece.cracks.whole = cracks.whole;
  const Lattice<3>& own = piece.part.lattice;
  if (cracks.whole &&
      (own.cells.size() != lattice.cells.size() || own.particles.size() != lattice.particles.size())) {
    piece.mesh = mesh_of_piece(*cracks.whole, own, piece.cracks.cell_of_whole, piece.cracks.faces);
    piece.cracks.open = std::move(piece.mesh.open);
  } else {
    piece.cracks.open = cracks.open;
  }
}

}  // namespace

Cracks<3> no_cracks(const TriangleMesh* mesh, const Lattice<3>& lattice, std::span<const float> strengths) {
  Cracks<3> cracks;
  take_all_faces(lattice, strengths, cracks);
  if (mesh == nullptr || mesh->triangles.empty()) return cracks;
  cracks.whole = std::make_shared<const CellMesh>(*mesh, lattice);
  hold_empty_cells(*cracks.whole, cracks);
  return cracks;
}

Cracks<2> no_cracks(const Lattice<2>& lattice, std::span<const float> strengths) {
  Cracks<2> cracks;
  take_all_faces(lattice, strengths, cracks);
  return cracks;
}

template <int kDimension>
CrackedPieces<kDimension> break_faces(const Lattice<kDimension>& lattice, const Cracks<kDimension>& cracks,
                                      std::span<const std::uint32_t> faces, std::uint32_t least_cells) {
  std::vector<bool> broken = cracks.is_broken;
  for (const std::uint32_t face : faces) {
    SC_ASSERT(face < broken.size(), "face {} of {} breaks", face, broken.size());
    if (std::isfinite(cracks.strength[face])) broken[face] = true;
  }
  std::vector<std::uint32_t> face_at(kDimension * lattice.cells.size());  // at kDimension low cell + axis
  for (std::uint32_t f = 0; f < cracks.faces.size(); ++f)
    face_at[kDimension * cracks.faces[f].low + cracks.faces[f].axis] = f;

  CrackedPieces<kDimension> pieces;
  for (LatticePiece<kDimension>& part : split<kDimension>(lattice, cracks.faces, broken)) {
    const bool is_largest = pieces.stay.empty();
    if (!is_largest && part.cell_of.size() < least_cells) {
      pieces.vanished.push_back(std::move(part.particle_of));
      continue;
    }
    CrackedPiece<kDimension>& piece = pieces.stay.emplace_back();
    take_faces_of_piece(part, cracks, broken, face_at, piece.cracks);
    piece.part = std::move(part);
    if constexpr (kDimension == 3) draw_piece(lattice, cracks, piece);
  }
  return pieces;
}

template CrackedPieces<2> break_faces(const Lattice<2>&, const Cracks<2>&, std::span<const std::uint32_t>,
                                      std::uint32_t);
template CrackedPieces<3> break_faces(const Lattice<3>&, const Cracks<3>&, std::span<const std::uint32_t>,
                                      std::uint32_t);

}  // namespace softcell::ppu
