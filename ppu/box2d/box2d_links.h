#pragma once
// Finds contacts and joints between rigid bodies near soft ones, as Box2D knows them.

#include <cstdint>
#include <span>
#include <vector>

#include "ppu/box2d/box2d_obstacles.h"
#include "ppu/surfaces/rigid_links.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more contacts, joints or bodies than ever before.
class Box2dLinks {
 public:
  /// Contacts and joints of the moving rigid bodies in `obstacles`, of the bodies that these touch or are joined to, and so on for a few
  /// bodies; adds the bodies found to `obstacles`. Uses Box2D's contacts of its last step, and its joints at the bodies' present places.
  /// @param attached  indices of rigid bodies to which soft ones are attached: their contacts and joints are left out
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
  std::vector<b2Contact*> contacts_;  // from which touches_ were made
  std::vector<b2Joint*> joints_;      // from which rows_ were made
};

}  // namespace softcell::ppu
