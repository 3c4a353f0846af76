#pragma once
// Where a model can break, and where it is broken.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ppu/fracture/cell_faces.h"
#include "ppu/fracture/cell_mesh.h"
#include "ppu/fracture/piece_mesh.h"

namespace softcell::ppu {

/// What both dimensions have: the faces of one model.
struct BreakableFaces {
  std::vector<std::uint32_t> cell_of_whole;  ///< of each cell: in the body that the model is a piece of
  std::vector<CellFace> faces;               ///< of the model's lattice
  std::vector<bool> is_broken;               ///< of each face
  /// Of each face: by which it is stronger than the settings say. Infinite of those by which cells in which nothing of the body lies hang
  /// on a neighbour: these never break.
  std::vector<float> strength;
};

/// Of one model. Immutable.
template <int kDimension>
struct Cracks;
template <>
struct Cracks<2> : BreakableFaces {};
template <>
struct Cracks<3> : BreakableFaces {
  std::shared_ptr<const CellMesh> whole;  ///< of the body that the model is a piece of; null: it has no mesh
  std::vector<OpenFace> open;             ///< ascending by cell; none where the model has no mesh
};

/// Of a model that was never broken.
/// @param mesh       null: it has none; of a whole lattice
/// @param strengths  of each cell; a face has that of the weaker one of its cells. Empty: all are 1
Cracks<3> no_cracks(const TriangleMesh* mesh, const Lattice<3>& lattice, std::span<const float> strengths);
Cracks<2> no_cracks(const Lattice<2>& lattice, std::span<const float> strengths);

/// A piece with all that a model of it is made of.
template <int kDimension>
struct CrackedPiece;
template <>
struct CrackedPiece<2> {
  LatticePiece<2> part;
  Cracks<2> cracks;
};
template <>
struct CrackedPiece<3> {
  LatticePiece<3> part;
  Cracks<3> cracks;
  /// The mesh without what `cracks` has; empty if the whole has no mesh, and if no crack has opened.
  PieceMesh mesh;
};

/// What comes of a body when some of its faces break.
template <int kDimension>
struct CrackedPieces {
  std::vector<CrackedPiece<kDimension>> stay;  ///< in the order of split()
  /// Of each piece that is too small to stay: which particles of the whole its own were, ascending.
  std::vector<std::vector<std::uint32_t>> vanished;
};

/// Faces that never break do not.
/// @param least_cells  pieces of fewer cells vanish, but for the largest one
template <int kDimension>
CrackedPieces<kDimension> break_faces(const Lattice<kDimension>& lattice, const Cracks<kDimension>& cracks,
                                      std::span<const std::uint32_t> faces, std::uint32_t least_cells);

}  // namespace softcell::ppu
