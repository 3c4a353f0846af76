#pragma once
// Which of Bullet's objects ever move.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

namespace softcell::ppu {

/// Whether Bullet or its owner may move an object. A body without mass is static to Bullet, and most owners who then declare it kinematic
/// leave that as it is: such a body is both.
inline bool may_move(const btCollisionObject& object) {
  return object.isKinematicObject() || !object.isStaticObject();
}

}  // namespace softcell::ppu
