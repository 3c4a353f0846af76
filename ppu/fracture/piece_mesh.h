#pragma once
// Makes the mesh of a piece: the part of the whole's mesh in its cells, closed where the piece ends or is open.

#include <cstdint>
#include <span>
#include <vector>

#include "ppu/fracture/cell_faces.h"
#include "ppu/fracture/cell_mesh.h"
#include "ppu/lattice/locate.h"

namespace softcell::ppu {

/// The name of the mesh material for cuts. If a mesh has no material of this name, its pieces get one without looks.
inline constexpr const char* kCutMaterial = "cut";

/// A face of a piece's cell at which the piece ends, or is separated from itself. In the whole another cell lay behind it.
struct OpenFace {
  std::uint32_t cell = 0;  ///< of the piece
  std::uint32_t axis = 0;
  bool is_high = false;                                  ///< it is the cell's high face along the axis
  std::uint32_t first_triangle = 0, triangle_count = 0;  ///< of the piece's mesh: they close it there
};

struct PieceMesh {
  TriangleMesh mesh;
  std::vector<PlaceInCell> places;  ///< of each vertex, in the piece's lattice: tells its side of a cut
  std::vector<OpenFace> open;       ///< ascending by cell
};

/// A face is open if one of its corners is no longer the same particle in both cells. Faces that are broken but not open yet are not drawn.
/// @param piece          cells as in the whole, particles of its own
/// @param cell_of_whole  of each cell of the piece
/// @param faces          of the piece
PieceMesh mesh_of_piece(const CellMesh& whole, const Lattice<3>& piece,
                        std::span<const std::uint32_t> cell_of_whole, std::span<const CellFace> faces);

}  // namespace softcell::ppu
