#pragma once
// The smooth shape with which a soft body in two dimensions is drawn: triangles and outlines whose vertices belong to the lattice's cells
// and deform with them. Make a skin once for each model, and deform it in each frame:
//
//     const Skin2d skin = make_skin_2d(model->lattice(), SoftBodyModel<2>::kContactRadiusInCells);   // once
//     ...
//     deform(skin, body.positions(), positions, slopes);                                             // each frame
//     draw_triangles(positions, skin.triangles);

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// A point that moves with a cell: the sum of the cell's corners, each times its share. The shares sum to 1. For a
/// point outside of its cell some shares are negative, and the point is extrapolated.
struct CellPoint2d {
  std::array<std::uint32_t, 4> corner{};  ///< particle numbers, in the order of Lattice<2>::corners
  std::array<float, 4> share{};

  /// The point's position, metres. @param particles  positions of all particles of the body, metres
  Eigen::Vector2f at(std::span<const Eigen::Vector2f> particles) const {
    return share[0] * particles[corner[0]] + share[1] * particles[corner[1]] +
           share[2] * particles[corner[2]] + share[3] * particles[corner[3]];
  }
};

/// The weights of one particle at a vertex: its share of the vertex's position, and its shares of the derivatives of
/// that position along the grid's x and y, for one cell's edge.
struct Pull2d {
  std::uint32_t particle = 0;
  float share = 0, along_x = 0, along_y = 0;
};

/// A drawn shape that belongs to the cells of one lattice, and bends without kinks between them.
struct Skin2d {
  std::vector<Eigen::Vector2f> rest;        ///< of each vertex: its place at rest, in grid coordinates
  std::vector<std::uint32_t> vertex_cells;  ///< of each vertex: the number of the cell that it belongs to
  /// The pulls that move vertex i: pulls first_pull[i] to first_pull[i + 1].
  std::vector<Pull2d> pulls;
  std::vector<std::uint32_t> first_pull{0};
  /// For each vertex at rest, the slope of a surface that is level in the middle of the body and falls off to its edge.
  /// It points outwards, is some 0.65 long at the edge, and (0, 0) farther than a cell and a half from the edge.
  std::vector<Eigen::Vector2f> slopes;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise at rest
  std::vector<std::uint32_t> cells;                     ///< of each triangle: the number of the nearest cell
  /// Closed loops of vertices: those around the body counter-clockwise, those around its holes clockwise.
  std::vector<std::vector<std::uint32_t>> outlines;
  float spacing = 0;  ///< edge of a cell, metres
};

/// The largest margin of make_skin_2d(), in cells; also how far outside of its cells a point of a lattice may be.
inline constexpr float kMaxSkinMargin = 0.5f;

/// The shape that a lattice's cells stand for, as a function of a point in grid coordinates: how many cells the point is
/// outside of the shape; negative inside.
using Outside2d = std::function<float(const Eigen::Vector2f&)>;

/// The shape of the lattice's cells, wider by `margin` all around, with round corners and without stairs. With a margin of the contact
/// radius the shape touches other things where the body does. Gaps that are one cell wide stay open. Deterministic.
/// @param margin   in cells, 0..kMaxSkinMargin
/// @param outside  a shape that is drawn instead of the cells, wider by the margin: a disc is round, however few cells
///                 it has. Its edge lies no farther than a cell outside of the cells.
/// @throws std::invalid_argument  the margin is out of its range
/// @pre  the lattice has cells
Skin2d make_skin_2d(const Lattice<2>& lattice, float margin, const Outside2d& outside = {});

/// The same shape in parts, for cells of several colours. Each point belongs to the part whose cells are nearest. The parts
/// cover the shape, and the lines between them are smooth. Deterministic.
/// @param parts  for each cell, the number of its part  @return  one skin for each number up to the largest
/// @throws std::invalid_argument  the margin is out of its range
/// @pre  the lattice has cells, and a part for each
std::vector<Skin2d> make_skin_parts_2d(const Lattice<2>& lattice, float margin, const Outside2d& outside,
                                       std::span<const std::uint32_t> parts);

/// Triangles for a picture that is transparent outside of the body: all cells of the lattice, and the cells around it for
/// which `drawn` returns true. It has no slopes and no outlines. Deterministic.
/// @param drawn  called with the grid index of the low corner of a cell that is not the lattice's
/// @pre  the lattice has cells; `drawn` is not empty
Skin2d make_cover_2d(const Lattice<2>& lattice, const std::function<bool(const Eigen::Vector2i&)>& drawn);

/// The skin of a piece of a broken body (fracture.h): the part of the whole skin in the piece's cells, cut along the cells' edges. The
/// skins of all pieces together are the whole skin. It also opens along cracks that do not go all the way through. At cuts there are no
/// slopes. If the whole skin has outlines, outlines go around the piece, cuts included. Deterministic.
/// @param whole    made by make_skin_2d() or make_cover_2d() for `lattice`
/// @param lattice  of the body before it first broke   @param piece  SoftBodyModel::lattice() of the piece
/// @pre  the piece is a part of that lattice
Skin2d skin_of_piece(const Skin2d& whole, const Lattice<2>& lattice, const Lattice<2>& piece);

/// @throws std::invalid_argument  the skin moves with cells or particles that the lattice has not, or its cells have another edge: it was
/// made for another lattice
void validate(const Skin2d& skin, const Lattice<2>& lattice);

/// The point bound to a cell, also if it lies outside of the cell.
/// @param cell  its number  @param at  grid coordinates: a particle of the lattice is at its grid index
CellPoint2d point_in_cell(const Lattice<2>& lattice, std::uint32_t cell, const Eigen::Vector2f& at);

/// Binds a point to the nearest cell, so that it moves with the cell.
/// @param at  grid coordinates: a particle of the lattice is at its grid index
/// @pre  the lattice has cells
CellPoint2d point_in_cells(const Lattice<2>& lattice, const Eigen::Vector2f& at);

/// Computes the positions of the vertices (metres) and the slopes there, rotated and stretched with the cells. Any thread.
/// @param particles  positions of the lattice's particles, metres
/// @param positions,slopes  receive one value for each vertex
/// @pre  both have as many elements as skin.rest; `particles` has one for each particle of the lattice
void deform(const Skin2d& skin, std::span<const Eigen::Vector2f> particles,
            std::span<Eigen::Vector2f> positions, std::span<Eigen::Vector2f> slopes);

}  // namespace softcell::ppu
