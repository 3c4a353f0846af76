#pragma once
// How soft bodies touch, and contacts.

#include <Eigen/Core>
#include <cstddef>

class btCollisionObject;

namespace softcell::ppu {

template <int kDimension>
class SoftBody;

/// The shape with which soft bodies touch.
enum class ContactMethod {
  /// A rigid sphere, in two dimensions a circle, at each outer particle. The engine moves them: the method of the report of 2008. Each
  /// outer particle costs a rigid body, and other things stop at a distance from the drawn shape.
  kSpheres,
  /// The drawn surface; the default. Points of the mesh's surface are tested against rigid shapes and other soft bodies; edges and points
  /// of those are tested against the body's distance field. The engine does not know of the body or its particles, so the engine's own
  /// rays, overlap tests and contact callbacks do not see it. Use cast_ray() and poll_contact_events() of BulletSoftBodies and
  /// Box2dSoftBodies, or SurfaceQuery for one body.
  kSurface,
};

/// Says which bodies may touch. Two bodies may touch if the group of each has a bit in common with the mask of the other. Groups are
/// Bullet's: by default moving bodies are in group 1, static ones in group 2.
struct CollisionFilter {
  int group = 1;
  int mask = -1;

  /// Whether two bodies with these filters may touch.
  bool may_touch(const CollisionFilter& other) const {
    return (group & other.mask) != 0 && (other.group & mask) != 0;
  }
};

/// How many cells are crushed, by contacts or otherwise.
struct CrushedCellCount {
  /// Cells with less than half of their volume at rest, including those that are turned inside out.
  std::size_t crushed = 0;
  std::size_t inside_out = 0;  ///< cells of negative volume
};

/// A point at which two bodies press on each other.
struct Contact {
  Eigen::Vector3f position{0, 0, 0};  ///< metres, in the world
  Eigen::Vector3f normal{0, 1, 0};    ///< unit length, from the second body to the first
  float impulse = 0;                  ///< kg m/s along the normal, in the last substep; above 0

  /// One of the two bodies: either a soft body or an object of the engine; the other pointer is null. If the body was removed since the
  /// substep, do not follow the pointer: the address only identifies the body.
  struct Body {
    const SoftBody<3>* soft = nullptr;
    const btCollisionObject* object = nullptr;

    bool operator==(const Body&) const = default;
  };
  Body first = {}, second = {};
};

/// A soft body touches something or is in a trigger volume. One event sums up all contacts of the two. ContactEvent and ContactEvent2d add
/// the object of Bullet or Box2D.
template <int kDimension>
struct SoftContactEvent {
  using Vector = Eigen::Vector<float, kDimension>;
  /// Whether the two touch now, and whether they did at the last call of poll_contact_events().
  enum class Kind {
    kBegin,    ///< they touch, and did not then
    kPersist,  ///< they touch, and did then
    /// They no longer touch. If one of them has been removed, its pointer only identifies it: do not dereference it.
    kEnd
  };
  Kind kind = Kind::kBegin;
  const SoftBody<kDimension>* body = nullptr;
  /// The other soft body, or `body` itself if it is folded; null if the other one is an object of the engine.
  const SoftBody<kDimension>* other = nullptr;
  /// Metres: the mean of the contact points, weighted by impulse; for a trigger volume, a point that both have in common.
  Vector position = Vector::Zero();
  /// Unit length, from the other one to `body`; for a trigger volume, the direction out of it.
  Vector normal = Vector::UnitY();
  /// kg m/s along the contacts' normals, summed since the last call; 0 for a trigger volume.
  float impulse = 0;
};

}  // namespace softcell::ppu
