#pragma once
// Finds contacts and joints between rigid bodies near soft ones, as Bullet knows them.

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <functional>
#include <vector>

#include "ppu/bullet/bullet_obstacles.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/obstacles/rigid_links.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more contacts, joints or objects than ever before.
class BulletLinks {
 public:
  /// Contacts and joints of the moving rigid bodies in `obstacles`, of the bodies that these touch or are joined to, and so on for a few
  /// bodies; adds the bodies found to `obstacles`. Uses Bullet's contacts of its last step, and its joints at the bodies' present places.
  /// @param is_attached  whether soft bodies are attached to an object: its contacts and joints are left out
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
  std::vector<const btPersistentManifold*> manifolds_;  // not in touches_ yet
  std::vector<const btPersistentManifold*> near_;       // those of bodies that have been reached
  std::vector<btTypedConstraint*> joints_;
  DisjointSets joined_;           // objects of the world
  std::vector<bool> is_reached_;  // for each of these sets
};

}  // namespace softcell::ppu
