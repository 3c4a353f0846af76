#pragma once
// How rigid bodies near soft ones touch each other or are joined, as Bullet knows it.

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <functional>
#include <vector>

#include "ppu/bullet/bullet_obstacles.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/surfaces/rigid_links.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more touches, joints or objects than ever before.
class BulletLinks {
 public:
  /// Those of the rigid bodies in `obstacles` that move, of what these touch or are joined to, and so on for a few bodies: what they touch is
  /// found in `obstacles`, too, from now on. By Bullet's contacts of its last step, and its joints, where bodies are now.
  /// @param is_attached  whether soft bodies are attached to an object: its touches and joints are left out
  /// @param step  seconds
  /// @return  valid until the next call
  RigidLinks find(const btDiscreteDynamicsWorld& world, BulletObstacles& obstacles,
                  const std::function<bool(const btCollisionObject&)>& is_attached, float step);

 private:
  bool is_reached(const btCollisionObject& object);
  void reach(const btCollisionObject& object);
  bool add_reached(BulletObstacles& obstacles,
                   const std::function<bool(const btCollisionObject&)>& is_attached);
  void add(const btPersistentManifold& manifold, BulletObstacles& obstacles);

  std::vector<RigidTouch> touches_;
  std::vector<JointRow> rows_;
  std::vector<const btPersistentManifold*> manifolds_;  // not among touches_ yet
  std::vector<const btPersistentManifold*> near_;       // of them: of what is reached
  std::vector<btTypedConstraint*> joints_;
  DisjointSets joined_;           // objects of the world
  std::vector<bool> is_reached_;  // of each set of these, by its name
};

}  // namespace softcell::ppu
