#pragma once
// Finds contacts and joints between rigid bodies near soft ones, as Box2D knows them.

#include <cstdint>
#include <span>
#include <vector>

#include "ppu/box2d/box2d_obstacles.h"
#include "ppu/obstacles/rigid_links.h"

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
  /// Whether the body's own contacts and joints are looked up.
  bool is_looked_up(const b2Body& body, std::uint32_t rigid) const;
  void add_contacts_of(std::uint32_t rigid, Box2dObstacles& obstacles);
  void add_joints_of(std::uint32_t rigid, Box2dObstacles& obstacles, float step);
  void add(b2Contact& contact, Box2dObstacles& obstacles);

  std::span<const std::uint32_t> attached_;  // during find()
  std::vector<RigidTouch> touches_;
  std::vector<JointRow> rows_;
};

}  // namespace softcell::ppu
