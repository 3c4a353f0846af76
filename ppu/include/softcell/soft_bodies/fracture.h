#pragma once
// Soft bodies that break, or that a program cuts: along the faces between their cells.
//
//     SoftBodySettings vase{.cell_size = 0.05f, .half_width = 2};
//     vase.fracture = Fracture{.stretch = 0.05f};
//     ...
//     world.stepSimulation(dt);
//     for (const BrokenSoftBody& broken : soft_bodies.poll_broken()) play_crash(broken.pieces.size());
//     soft_bodies.cut(loaf, Cut::plane(knife, {1, 0, 0}));
//
// When a body breaks, the object becomes the largest piece, so references to it stay valid. All other pieces are new bodies. A piece has
// its own model, the velocities that its particles had, and the material of the whole body. A particle at a crack is split into several,
// which share its mass; so the pieces together have the mass and both momenta of the whole. Regions do not reach across a crack, not even
// where the body is still connected. The mesh opens along the broken faces, and the cut of the solid with these faces closes both sides: a
// part of its own, object "cut", in the mesh's material "cut". If the mesh has no material of that name, the meshes of pieces have one more
// than it, without looks. A piece may be as small as a single cell, a body of eight particles. By default no piece vanishes. With
// Fracture::least_cells, pieces of fewer cells vanish and take their mass and momenta with them.
//
// Bodies of two dimensions break in the same way (box2d/box2d_soft_bodies.h). There a face is an edge between two squares, and a single
// cell is a body of four particles. skin_of_piece() in skin_2d.h makes the drawn shape of a piece.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// Where a program cuts bodies: a parallelogram or a plane, in world coordinates. A face between two cells breaks when the cut separates
/// the middles of the two cells.
struct Cut {
  Eigen::Vector3f corner{0, 0, 0};  ///< metres
  Eigen::Vector3f along{1, 0, 0};   ///< metres: a side of a parallelogram, from its corner
  Eigen::Vector3f across{0, 1, 0};  ///< metres: the other side, from the same corner
  bool has_end = true;              ///< false: the whole plane in which the parallelogram lies

  /// A whole plane. @param point  metres, in the plane  @param normal  of any length but 0
  static Cut plane(const Eigen::Vector3f& point, const Eigen::Vector3f& normal);
  /// The area that a blade sweeps: its edge reaches from `tip` to `tip` + `edge`, and it moves by `way` (metres).
  static Cut stroke(const Eigen::Vector3f& tip, const Eigen::Vector3f& edge, const Eigen::Vector3f& way) {
    return {.corner = tip, .along = edge, .across = way};
  }
};

/// Where a program cuts bodies of two dimensions: along a line, or a segment of it.
struct Cut2d {
  Eigen::Vector2f from{0, 0};  ///< metres: one end of the segment
  Eigen::Vector2f way{1, 0};   ///< metres: from there to the other end
  bool has_end = true;         ///< false: the whole line on which the segment lies

  /// A whole line. @param point  metres, on the line  @param normal  of any length but 0
  static Cut2d line(const Eigen::Vector2f& point, const Eigen::Vector2f& normal) {
    return {.from = point, .way = {-normal.y(), normal.x()}, .has_end = false};
  }
  /// The segment that a tip sweeps when it moves by `way` (metres).
  static Cut2d stroke(const Eigen::Vector2f& tip, const Eigen::Vector2f& way) {
    return {.from = tip, .way = way};
  }
};

/// The result of a break, as BulletSoftBodies::poll_broken() and Box2dSoftBodies::poll_broken() return it.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct BrokenBody {
  SoftBody<kDimension>* body = nullptr;  ///< the body, now its largest piece
  /// The new bodies. Empty: the body has cracks but is still connected, or all other pieces have vanished.
  std::vector<SoftBody<kDimension>*> pieces;
  std::size_t faces = 0;  ///< how many faces broke
  /// How many pieces were too small to stay (Fracture::least_cells). The lists here do not contain them, nor particles that only they had.
  std::size_t vanished = 0;
  /// One list for `body`, then one for each of `pieces`: for each particle, its number in the body before the break. A particle at a crack
  /// has been split into several, which all have its number.
  std::vector<std::vector<std::uint32_t>> particles_before;
};
using BrokenSoftBody = BrokenBody<3>;    ///< in a Bullet world
using BrokenSoftBody2d = BrokenBody<2>;  ///< in a Box2D world

// For bodies without an engine. BulletSoftBodies and Box2dSoftBodies have functions of their own for their bodies.

/// Breaks the body where it is strained beyond the limits of its settings; `body` becomes the largest piece. @return  the other pieces that
/// stay
std::vector<SoftBody<3>> break_where_strained(SoftBody<3>& body);
std::vector<SoftBody<2>> break_where_strained(SoftBody<2>& body);  ///< the same in two dimensions
/// Cuts a body, whether it has a fracture or not; `body` becomes the largest piece. @return  the other pieces that stay
/// @throws std::invalid_argument  the cut is not finite, or has no area
std::vector<SoftBody<3>> cut(SoftBody<3>& body, const Cut& where);
/// The same in two dimensions. @throws std::invalid_argument  the cut is not finite, or has no length
std::vector<SoftBody<2>> cut(SoftBody<2>& body, const Cut2d& where);

}  // namespace softcell::ppu
