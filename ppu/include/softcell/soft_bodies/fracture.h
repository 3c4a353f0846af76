#pragma once
// Soft bodies that break, or that a program cuts: along the faces between their cells.
//
//     SoftBodySettings vase{.cell_size = 0.05f, .half_width = 2};
//     vase.fracture = Fracture{.stretch = 0.05f};
//     ...
//     world.stepSimulation(dt);
//     for (const BrokenSoftBody& broken : soft_bodies.take_broken()) play_crash(broken.pieces.size());
//     soft_bodies.cut(loaf, Cut::plane(knife, {1, 0, 0}));
//
// A body that breaks becomes its largest piece, where it is in memory: nobody's reference dangles. All other pieces are new bodies. A
// piece has a model of its own, the velocities that its particles had, and the material of the whole. Particles at a crack become
// several, and share the mass of the one that they were; so masses and both momenta are those of the whole. Regions do not reach
// across a crack, also where the body still hangs together. The mesh opens along the faces, and both sides are closed by the cut of the
// solid with them, in the mesh's material "cut". However small a piece is, it stays: a single cell is a body of eight particles.
//
// In two dimensions all is the same (box2d/box2d_soft_bodies.h): a face is an edge between two squares, a single cell has four particles,
// and skin_of_piece() of skin_2d.h is what is drawn of a piece.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// Where a program cuts bodies, as they are now. A face breaks when the middles of its two cells lie on different sides of it.
struct Cut {
  Eigen::Vector3f corner{0, 0, 0};  ///< metres
  Eigen::Vector3f along{1, 0, 0};   ///< metres: a side of a parallelogram, from its corner
  Eigen::Vector3f across{0, 1, 0};  ///< and the other one
  bool has_end = true;              ///< false: the whole plane in which it lies

  /// @param normal  of any length but 0
  static Cut plane(const Eigen::Vector3f& point, const Eigen::Vector3f& normal);
  /// What a blade passes: `edge` from its tip, moved by `way`.
  static Cut stroke(const Eigen::Vector3f& tip, const Eigen::Vector3f& edge, const Eigen::Vector3f& way) {
    return {.corner = tip, .along = edge, .across = way};
  }
};

/// The same in two dimensions: along a stretch of a line.
struct Cut2d {
  Eigen::Vector2f from{0, 0};  ///< metres: one end of the stretch
  Eigen::Vector2f way{1, 0};   ///< metres: from there to the other end
  bool has_end = true;         ///< false: the whole line on which it lies

  /// @param normal  of any length but 0
  static Cut2d line(const Eigen::Vector2f& point, const Eigen::Vector2f& normal) {
    return {.from = point, .way = {-normal.y(), normal.x()}, .has_end = false};
  }
  /// What a tip passes on its way.
  static Cut2d stroke(const Eigen::Vector2f& tip, const Eigen::Vector2f& way) {
    return {.from = tip, .way = way};
  }
};

/// What a break has left of a body, as BulletSoftBodies::take_broken() and Box2dSoftBodies::take_broken() return it.
/// @tparam kDimension  2 or 3
template <int kDimension>
struct BrokenBody {
  SoftBody<kDimension>* body = nullptr;       ///< what is left of it: its largest piece
  std::vector<SoftBody<kDimension>*> pieces;  ///< new bodies; none: it is cracked and hangs together
  std::size_t faces = 0;                      ///< that broke
  /// Of `body`, then of each of `pieces`: for each particle which one of the body before the break it was. Particles at a crack are several.
  std::vector<std::vector<std::uint32_t>> particles_before;
};
using BrokenSoftBody = BrokenBody<3>;    ///< in a Bullet world
using BrokenSoftBody2d = BrokenBody<2>;  ///< in a Box2D world

// Without an engine. For a body that BulletSoftBodies or Box2dSoftBodies has, use their own functions.

/// Breaks what is strained beyond the limits of its settings. @return the pieces but the largest, which `body` becomes
std::vector<SoftBody<3>> break_where_strained(SoftBody<3>& body);
std::vector<SoftBody<2>> break_where_strained(SoftBody<2>& body);  ///< the same in two dimensions
/// Cuts a body, whatever its settings. @return as above
/// @throws std::invalid_argument  the cut is not finite, or has no area
std::vector<SoftBody<3>> cut(SoftBody<3>& body, const Cut& where);
/// The same in two dimensions. @throws std::invalid_argument  the cut is not finite, or has no length
std::vector<SoftBody<2>> cut(SoftBody<2>& body, const Cut2d& where);

}  // namespace softcell::ppu
