#pragma once
// The collision shape of all outer particles of one soft body.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "softcell/base/assert.h"

namespace softcell::ppu {

/// A sphere of two radii that meets contacts early.
///
/// Two radii: against rigid shapes the sphere is small, so that the mesh lies close to what it lies on. Such small spheres, a cell apart,
/// would slip through the gaps of another body's, so among themselves they are large enough to close them. Bullet makes that easy: for GJK,
/// which handles convex shapes, a sphere is a point with a margin; for the sphere-sphere algorithm it has a radius. (A rigid btSphereShape
/// and triangle meshes also see the large radius.)
///
/// Early contacts: Bullet makes a contact as soon as two shapes are nearer than the smaller of their "breaking thresholds", and lets the
/// solver use up exactly the remaining distance. A sphere's default threshold is 2 % of its radius, so a sphere of 3 cm that moves 5 cm in
/// a substep would be inside the floor before there is a contact. With a threshold of the longest motion in a substep it stops at the
/// surface instead; the other shape's threshold (2 % of its size, 17 cm for a floor of 12 m) still limits it. Bullet's own continuous
/// collision detection costs a sweep through the broad phase for each fast particle, and hits particles of the same body.
class ContactSphere final : public btSphereShape {
 public:
  /// All in metres.
  /// @param radius       against rigid shapes
  /// @param soft_radius  against other particles
  /// @param reach        the longest motion of a particle in one substep
  ContactSphere(float radius, float soft_radius, float reach)
      : btSphereShape(soft_radius), radius_(radius), reach_(reach) {
    SC_ASSERT(radius > 0 && soft_radius > 0 && reach > 0, "spheres of {} m and {} m that move {} m", radius,
              soft_radius, reach);
    setUserPointer(tag());
  }

  btScalar getMargin() const override { return radius_; }
  btScalar getContactBreakingThreshold(btScalar) const override { return reach_; }
  void getAabb(const btTransform& pose, btVector3& low, btVector3& high) const override {
    const btVector3 extent(getRadius(), getRadius(), getRadius());
    low = pose.getOrigin() - extent;
    high = pose.getOrigin() + extent;
  }

  /// Whether an object is a particle of a soft body. We use the user pointer of such an object to tell bodies apart.
  static bool is_shape_of(const btCollisionObject& object) {
    return object.getCollisionShape()->getUserPointer() == tag();
  }

 private:
  /// An address that nobody else uses.
  static void* tag() {
    static char unique;
    return &unique;
  }

  float radius_, reach_;
};

}  // namespace softcell::ppu
