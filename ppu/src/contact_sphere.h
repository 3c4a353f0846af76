#pragma once
// The collision shape of all outer particles of one soft body.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

namespace softcell::ppu {

/// A small sphere that meets contacts early.
///
/// Bullet makes a contact as soon as two shapes are nearer than the smaller of their "breaking thresholds",
/// and lets the solver use up exactly the distance that is left. A sphere's own threshold would be 2 % of its
/// radius, so that one of 3 cm, moving 5 cm in a substep, would be inside the floor before there is a
/// contact. With a threshold of one substep's longest way it arrives at the surface instead; the other
/// shape's threshold (2 % of its size, 17 cm for a floor of 12 m) still bounds it. Bullet's own continuous
/// collision costs a sweep through the broad phase for each fast particle, and hits particles of the same
/// body.
class ContactSphere final : public btSphereShape {
 public:
  /// @param reach  metres: the longest way of a particle in one substep
  ContactSphere(float radius, float reach) : btSphereShape(radius), reach_(reach) { setUserPointer(tag()); }

  btScalar getContactBreakingThreshold(btScalar) const override { return reach_; }

  /// Whether an object is a particle of a soft body. The user pointer of such an object is ours: it tells
  /// bodies apart.
  static bool is_shape_of(const btCollisionObject& object) {
    return object.getCollisionShape()->getUserPointer() == tag();
  }

 private:
  /// An address that is nobody else's.
  static void* tag() {
    static char unique;
    return &unique;
  }

  float reach_;
};

}  // namespace softcell::ppu
