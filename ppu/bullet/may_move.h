#pragma once
// Tells which of Bullet's objects may ever move, and how fast they do.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace softcell::ppu {

/// Whether Bullet or the program may move an object. For Bullet, a body without mass is static, and most programs that then declare it
/// kinematic leave the static flag set: such a body is both.
inline bool may_move(const btCollisionObject& object) {
  return object.isKinematicObject() || !object.isStaticObject();
}

/// m/s. Bullet does not look at what a static body has been given as its velocity, or has kept from when it moved.
inline btVector3 velocity_of(const btRigidBody& body) {
  return may_move(body) ? body.getLinearVelocity() : btVector3(0, 0, 0);
}
/// rad/s, likewise
inline btVector3 spin_of(const btRigidBody& body) {
  return may_move(body) ? body.getAngularVelocity() : btVector3(0, 0, 0);
}

}  // namespace softcell::ppu
