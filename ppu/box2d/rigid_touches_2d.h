#pragma once
// Where rigid bodies near soft ones touch each other, as Box2D knows it.

#include <cstdint>
#include <span>
#include <vector>

#include "ppu/box2d/box2d_obstacles.h"
#include "ppu/surfaces/contact_rigid.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more touches or bodies than ever before.
class RigidTouches2d {
 public:
  /// Those of the rigid bodies in `obstacles` that move, of what these touch, and so on for a few bodies: what they touch is found in
  /// `obstacles`, too, from now on. By Box2D's contacts of its last step, where bodies are now.
  /// @param attached  indices of rigid bodies to which soft ones are attached: their touches are left out
  /// @return  valid until the next call
  std::span<const RigidTouch> find(Box2dObstacles& obstacles, std::span<const std::uint32_t> attached);

 private:
  void add(b2Contact& contact, Box2dObstacles& obstacles);

  std::vector<RigidTouch> touches_;
  std::vector<b2Contact*> contacts_;  // that touches_ are of
};

}  // namespace softcell::ppu
