#pragma once
// Tells which of Bullet's objects may ever move.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

namespace softcell::ppu {

/// Whether Bullet or the program may move an object. For Bullet, a body without mass is static, and most programs that then declare it
/// kinematic leave the static flag set: such a body is both.
inline bool may_move(const btCollisionObject& object) {
  return object.isKinematicObject() || !object.isStaticObject();
}

}  // namespace softcell::ppu
