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

/// Of one model. Immutable.
struct Cracks {
  std::shared_ptr<const CellMesh> whole;  ///< of the body that the model is a piece of; null: it has no mesh
  std::vector<std::uint32_t> cell_of_whole;  ///< of each cell
  std::vector<CellFace> faces;               ///< of the model's lattice
  std::vector<bool> is_broken;               ///< of each face
  /// Of each face: by which it is stronger than the settings say. Infinite of those by which cells in which nothing of the body lies hang
  /// on a neighbour: these never break.
  std::vector<float> strength;
  std::vector<OpenFace> open;  ///< ascending by cell; none where the model has no mesh
};

/// Of a model that was never broken.
/// @param mesh       null: it has none; of a whole lattice
/// @param strengths  of each cell; a face has that of the weaker one of its cells. Empty: all are 1
Cracks no_cracks(const TriangleMesh* mesh, const Lattice<3>& lattice, std::span<const float> strengths);

/// A piece with all that a model of it is made of.
struct CrackedPiece {
  LatticePiece part;
  Cracks cracks;
  PieceMesh
      mesh;  ///< without what `cracks` has; empty where the whole has none, and where no crack has opened
};

/// What is left when some faces break, in the order of split(). Those that never break do not.
std::vector<CrackedPiece> break_faces(const Lattice<3>& lattice, const Cracks& cracks,
                                      std::span<const std::uint32_t> faces);

}  // namespace softcell::ppu
