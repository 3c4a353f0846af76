#include "ppu/box2d/rigid_touches_2d.h"

#include <box2d/b2_collision.h>
#include <box2d/b2_contact.h>

#include <algorithm>
#include <cstddef>

namespace softcell::ppu {
std::span<const RigidTouch> RigidTouches2d::find(Box2dObstacles& obstacles,
                                                 std::span<const std::uint32_t> attached) {
  touches_.clear();
  contacts_.clear();
  const auto is_attached = [&](std::uint32_t rigid) {
    return std::ranges::find(attached, rigid) != attached.end();
  };
  std::size_t first = 0;
  for (int i = 0; i <= kFarthestTouch; ++i) {
    const std::size_t end = obstacles.bodies().size();
    for (std::size_t rigid = first; rigid < end; ++rigid) {
      b2Body& body = *obstacles.bodies()[rigid];
      if (body.GetType() != b2_dynamicBody || is_attached(static_cast<std::uint32_t>(rigid))) continue;
      for (b2ContactEdge* edge = body.GetContactList(); edge != nullptr; edge = edge->next) {
        b2Contact& contact = *edge->contact;
        const bool counts = contact.IsTouching() && contact.IsEnabled() &&
                            !contact.GetFixtureA()->IsSensor() && !contact.GetFixtureB()->IsSensor();
        if (!counts || std::ranges::find(contacts_, &contact) != contacts_.end()) continue;
        contacts_.push_back(&contact);
        if (!is_attached(obstacles.rigid_of(*edge->other))) add(contact, obstacles);
      }
    }
    first = end;
  }
  return touches_;
}

/// Box2D's normals point from its first fixture to the second one.
void RigidTouches2d::add(b2Contact& contact, Box2dObstacles& obstacles) {
  b2WorldManifold manifold;
  contact.GetWorldManifold(&manifold);
  const std::uint32_t a = obstacles.rigid_of(*contact.GetFixtureB()->GetBody());
  const std::uint32_t b = obstacles.rigid_of(*contact.GetFixtureA()->GetBody());
  for (int i = 0; i < contact.GetManifold()->pointCount; ++i)
    touches_.push_back({.a = a,
                        .b = b,
                        .point = {manifold.points[i].x, manifold.points[i].y, 0},
                        .normal = {manifold.normal.x, manifold.normal.y, 0},
                        .gap = manifold.separations[i],
                        .friction = contact.GetFriction()});
}

}  // namespace softcell::ppu
