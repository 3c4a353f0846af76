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

#include <Eigen/Core>
#include <cstddef>
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

/// What a break has left of a body, as BulletSoftBodies::take_broken() returns it.
struct BrokenSoftBody {
  SoftBody<3>* body = nullptr;       ///< what is left of it: its largest piece
  std::vector<SoftBody<3>*> pieces;  ///< new bodies; none: it is cracked and hangs together
  std::size_t faces = 0;             ///< that broke
};

// Without an engine. For a body that BulletSoftBodies has, use its own functions.

/// Breaks what is strained beyond the limits of its settings. @return the pieces but the largest, which `body` becomes
std::vector<SoftBody<3>> break_where_strained(SoftBody<3>& body);
/// Cuts a body, whatever its settings. @return as above
/// @throws std::invalid_argument  the cut is not finite, or has no area
std::vector<SoftBody<3>> cut(SoftBody<3>& body, const Cut& where);

}  // namespace softcell::ppu
