#pragma once
// How rigid bodies near soft ones touch each other or are joined, as Box2D knows it.

#include <cstdint>
#include <span>
#include <vector>

#include "ppu/box2d/box2d_obstacles.h"
#include "ppu/surfaces/rigid_links.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more touches, joints or bodies than ever before.
class Box2dLinks {
 public:
  /// Those of the rigid bodies in `obstacles` that move, of what these touch or are joined to, and so on for a few bodies: what they touch is
  /// found in `obstacles`, too, from now on. By Box2D's contacts of its last step, and its joints, where bodies are now.
  /// @param attached  indices of rigid bodies to which soft ones are attached: their touches and joints are left out
  /// @param step  seconds
  /// @return  valid until the next call
  RigidLinks find(Box2dObstacles& obstacles, std::span<const std::uint32_t> attached, float step);

 private:
  void add_contacts_of(b2Body& body, Box2dObstacles& obstacles, std::span<const std::uint32_t> attached);
  void add_joints_of(b2Body& body, Box2dObstacles& obstacles, std::span<const std::uint32_t> attached,
                     float step);
  void add(b2Contact& contact, Box2dObstacles& obstacles);

  std::vector<RigidTouch> touches_;
  std::vector<JointRow> rows_;
  std::vector<b2Contact*> contacts_;  // that touches_ are of
  std::vector<b2Joint*> joints_;      // that rows_ are of
};

}  // namespace softcell::ppu
