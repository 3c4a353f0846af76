#pragma once
// The faces along which a model can break, and those that are broken.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ppu/fracture/cell_faces.h"
#include "ppu/fracture/cell_mesh.h"
#include "ppu/fracture/piece_mesh.h"

namespace softcell::ppu {

/// The faces of one model, in both dimensions.
struct BreakableFaces {
  std::vector<std::uint32_t> cell_of_whole;  ///< of each cell: its number in the whole body
  std::vector<CellFace> faces;               ///< of the model's lattice
  std::vector<bool> is_broken;               ///< of each face
  /// For each face, its strength as a multiple of the limits in the settings. Infinite for faces that attach an empty cell, one that
  /// contains nothing of the body, to a neighbour: these never break.
  std::vector<float> strength;
};

/// The cracks of one model. Immutable.
template <int kDimension>
struct Cracks;
template <>
struct Cracks<2> : BreakableFaces {};
template <>
struct Cracks<3> : BreakableFaces {
  std::shared_ptr<const CellMesh> whole;  ///< of the body that the model is a piece of; null: no mesh
  std::vector<OpenFace> open;             ///< ascending by cell; empty if the model has no mesh
};

/// The cracks of a model that was never broken.
/// @param mesh       null: the model has none; belongs to a whole lattice
/// @param strengths  of each cell; a face has the strength of the weaker one of its cells. Empty: all are 1
Cracks<3> no_cracks(const TriangleMesh* mesh, const Lattice<3>& lattice, std::span<const float> strengths);
Cracks<2> no_cracks(const Lattice<2>& lattice, std::span<const float> strengths);

/// A piece, with everything that a model of it is made from.
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
  /// The piece's mesh without the parts that are in `cracks`; empty if the whole has no mesh, or no crack has opened.
  PieceMesh mesh;
};

/// The pieces of a body when some of its faces break.
template <int kDimension>
struct CrackedPieces {
  std::vector<CrackedPiece<kDimension>> stay;  ///< in the order of split()
  /// For each piece that is too small to stay: the numbers of its particles in the whole, ascending.
  std::vector<std::vector<std::uint32_t>> vanished;
};

/// Breaks faces, except for those that never break.
/// @param least_cells  pieces of fewer cells vanish, except for the largest piece
template <int kDimension>
CrackedPieces<kDimension> break_faces(const Lattice<kDimension>& lattice, const Cracks<kDimension>& cracks,
                                      std::span<const std::uint32_t> faces, std::uint32_t least_cells);

}  // namespace softcell::ppu
