#pragma once
// How soft bodies touch, and where they do.

#include <Eigen/Core>
#include <cstddef>

class btCollisionObject;

namespace softcell::ppu {

template <int kDimension>
class SoftBody;

/// What soft bodies touch with.
enum class ContactMethod {
  /// A rigid sphere at each outer particle, which the engine moves: the way of the report of 2008. Costs a
  /// rigid body for each, and things are kept at a distance from what is drawn.
  kSpheres,
  /// What is drawn, unless a program asks for the other: points of the mesh's surface meet rigid shapes and other soft bodies, whose edges and
  /// points meet the body's distance field. The engine knows nothing of the body, and no rigid body stands
  /// for its particles, so that its own rays, overlap tests and contact callbacks do not see it:
  /// BulletSoftBodies has cast_ray() and take_contact_events(), and SurfaceQuery looks at one body.
  kSurface,
};

/// What may touch what: two bodies do if the group of each has a bit in common with the mask of the other. The numbers are Bullet's, where 1 is
/// what moves and 2 what stands still.
struct CollisionFilter {
  int group = 1;
  int mask = -1;

  /// Whether two with these filters may touch.
  bool lets(const CollisionFilter& other) const {
    return (group & other.mask) != 0 && (other.group & mask) != 0;
  }
};

/// Cells that contacts have pressed to less than a part of their volume.
struct CrushedCellCount {
  std::size_t crushed = 0;  ///< cells with less than half of their volume, those turned inside out included
  std::size_t inside_out = 0;  ///< cells of negative volume
};

/// A point at which two bodies press on each other.
struct Contact {
  Eigen::Vector3f position{0, 0, 0};  ///< metres, in the world
  Eigen::Vector3f normal{0, 1, 0};    ///< unit length, from the second body to the first
  float impulse = 0;                  ///< kg m/s along the normal, in the last substep; above 0

  /// One of the two: a soft body, or something that the engine knows; the other pointer is null. Of a body that was removed since that
  /// substep the address is only a name.
  struct Body {
    const SoftBody<3>* soft = nullptr;
    const btCollisionObject* object = nullptr;

    bool operator==(const Body&) const = default;
  };
  Body first = {}, second = {};
};

}  // namespace softcell::ppu
