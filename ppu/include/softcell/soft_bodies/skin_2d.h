#pragma once
// The smooth shape with which a soft body in two dimensions is drawn: triangles and outlines whose vertices hang in
// the lattice's cells and deform with them. Made once for each model, placed with the positions of the moment:
//
//     const Skin2d skin = make_skin_2d(model->lattice(), SoftBodyModel<2>::kContactRadiusInCells);   // once
//     ...
//     place(skin, body.positions(), positions, slopes);                                             // each frame
//     draw_triangles(positions, skin.triangles);

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// A point that moves with a cell: the sum of the corners, each times its share. The shares sum to 1; those of a
/// point outside of its cell extrapolate.
struct CellPoint2d {
  std::array<std::uint32_t, 4> corner{};  ///< particle numbers, in the order of Lattice<2>::corners
  std::array<float, 4> share{};

  /// Where the point is. @param particles  positions of all particles of the body, metres
  Eigen::Vector2f at(std::span<const Eigen::Vector2f> particles) const {
    return share[0] * particles[corner[0]] + share[1] * particles[corner[1]] +
           share[2] * particles[corner[2]] + share[3] * particles[corner[3]];
  }
};

/// What one particle does to a vertex: its share of the vertex's position, and of how the position changes along the
/// cells' edges, a cell long.
struct Pull2d {
  std::uint32_t particle = 0;
  float share = 0, along_x = 0, along_y = 0;
};

/// A drawn shape that hangs in the cells of one lattice, and bends without kinks between them.
struct Skin2d {
  std::vector<Eigen::Vector2f> rest;        ///< of each vertex: where it is at rest, in grid coordinates
  std::vector<std::uint32_t> vertex_cells;  ///< of each vertex: the number of the cell that it hangs in
  /// What moves vertex i: pulls first_pull[i] to first_pull[i + 1].
  std::vector<Pull2d> pulls;
  std::vector<std::uint32_t> first_pull{0};
  /// Of each vertex at rest: where the edge is, and how near. As a surface that is level in the middle and falls off
  /// to the edge has its slope: (0, 0) farther than a cell and a half from the edge, some 0.65 long on it, outwards.
  std::vector<Eigen::Vector2f> slopes;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise at rest
  std::vector<std::uint32_t> cells;                     ///< of each triangle: the number of the nearest cell
  /// Closed loops of vertices: those around the body counter-clockwise, those around its holes clockwise.
  std::vector<std::vector<std::uint32_t>> outlines;
  float spacing = 0;  ///< edge of a cell, metres
};

/// Most of make_skin_2d()'s margin; also how far outside of its cells a lattice's points may be.
inline constexpr float kMaxSkinMargin = 0.5f;

/// A shape that a lattice's cells stand for: how far outside of it a point, in grid coordinates, is, in cells; negative
/// inside.
using Outside2d = std::function<float(const Eigen::Vector2f&)>;

/// The lattice's cells, wider by `margin` all around, with round corners and without stairs. With a margin of the
/// contact radius the shape meets other things where the body does. Gaps that are one cell wide stay open.
/// Deterministic.
/// @param margin   in cells, 0..kMaxSkinMargin
/// @param outside  a shape that is drawn in place of the cells, wider by the margin: a disc is round, however few cells
///                 it has. Its edge lies no farther than a cell outside of the cells.
/// @pre  the lattice has cells
Skin2d make_skin_2d(const Lattice<2>& lattice, float margin, const Outside2d& outside = {});

/// The same shape in parts, for cells of several colours: what is nearest to a part's cells is of that part. The parts
/// cover the shape, and the lines between them are smooth. Deterministic.
/// @param parts   of each cell the number of its part  @return  one skin for each number up to the largest
/// @pre  the lattice has cells, and a part for each
std::vector<Skin2d> make_skin_parts_2d(const Lattice<2>& lattice, float margin, const Outside2d& outside,
                                       std::span<const std::uint32_t> parts);

/// All cells of the lattice and those around it that `drawn` asks for, as triangles: for a picture that is
/// transparent outside of the body. It has no slopes and no outlines. Deterministic.
/// @param drawn  asked of cells beside the lattice's, by the grid index of their low corner
/// @pre  the lattice has cells
Skin2d make_cover_2d(const Lattice<2>& lattice, const std::function<bool(const Eigen::Vector2i&)>& drawn);

/// What of a body's shape belongs to the cells of a piece of it (fracture.h), cut along the cells' edges: the skins of all pieces together are that of the
/// whole. It opens along cracks that do not go all the way through, too. Cuts are edges of the shape, without slopes; outlines go
/// around all of it, if the whole has any. Deterministic.
/// @param whole  of make_skin_2d() or make_cover_2d(), of the lattice that was never broken   @param piece  SoftBodyModel::lattice() of the piece
/// @pre  the piece is of that lattice
Skin2d skin_of_piece(const Skin2d& whole, const Lattice<2>& lattice, const Lattice<2>& piece);

/// The point of the nearest cell.
/// @param at  grid coordinates: a particle of the lattice is at its grid index
/// @pre  the lattice has cells
CellPoint2d point_in_cells(const Lattice<2>& lattice, const Eigen::Vector2f& at);

/// Where the vertices are, and the slopes there, turned and stretched with the cells.
/// @param particles  positions of the lattice's particles, metres
/// @param positions,slopes  one for each vertex
/// @pre  the sizes fit
void place(const Skin2d& skin, std::span<const Eigen::Vector2f> particles,
           std::span<Eigen::Vector2f> positions, std::span<Eigen::Vector2f> slopes);

}  // namespace softcell::ppu
