#pragma once
// Where rigid bodies near soft ones touch each other, as Bullet knows it.

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <functional>
#include <span>
#include <vector>

#include "ppu/bullet/bullet_obstacles.h"
#include "ppu/surfaces/contact_rigid.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more touches or objects than ever before.
class RigidTouches {
 public:
  /// Those of the rigid bodies in `obstacles` that move, of what these touch, and so on for a few bodies: what they touch is found in
  /// `obstacles`, too, from now on. By Bullet's contacts of its last step, where bodies are now.
  /// @param is_attached  whether soft bodies are attached to an object: its touches are left out
  /// @return  valid until the next call
  std::span<const RigidTouch> find(const btDiscreteDynamicsWorld& world, BulletObstacles& obstacles,
                                   const std::function<bool(const btCollisionObject&)>& is_attached);

 private:
  void reach(const btCollisionObject& object);
  bool add_reached(BulletObstacles& obstacles,
                   const std::function<bool(const btCollisionObject&)>& is_attached);
  void add(const btPersistentManifold& manifold, BulletObstacles& obstacles);

  std::vector<RigidTouch> touches_;
  std::vector<const btPersistentManifold*> manifolds_;  // not among touches_ yet
  std::vector<const btPersistentManifold*> near_;       // of them: of what is reached
  std::vector<bool> is_reached_;                        // of each object of the world
};

}  // namespace softcell::ppu
