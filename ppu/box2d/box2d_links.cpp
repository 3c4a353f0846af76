#include "ppu/box2d/box2d_links.h"

#include <box2d/b2_collision.h>
#include <box2d/b2_contact.h>
#include <box2d/b2_joint.h>

#include <algorithm>
#include <cstddef>

#include "ppu/box2d/joint_rows_2d.h"

namespace softcell::ppu {
namespace {

template <typename Range, typename Item>
bool contains(const Range& range, const Item& item) {
  return std::ranges::find(range, item) != range.end();
}

}  // namespace

RigidLinks Box2dLinks::find(Box2dObstacles& obstacles, std::span<const std::uint32_t> attached, float step) {
  touches_.clear();
  contacts_.clear();
  rows_.clear();
  joints_.clear();
  // Each body appends those that it touches or is joined to.
  std::size_t first = 0;
  for (int i = 0; i <= kFarthestTouch; ++i) {
    const auto for_each_new = [&](const auto& work) {
      for (std::size_t rigid = first; rigid < obstacles.bodies().size(); ++rigid) {
        b2Body& body = *obstacles.bodies()[rigid];
        if (body.GetType() == b2_dynamicBody && !contains(attached, static_cast<std::uint32_t>(rigid)))
          work(body);
      }
    };
    for_each_new([&](b2Body& body) { add_joints_of(body, obstacles, attached, step); });
    const std::size_t end = obstacles.bodies().size();
    for_each_new([&](b2Body& body) {
      if (obstacles.rigid_of(body) < end) add_contacts_of(body, obstacles, attached);
    });
    first = end;
  }
  return {touches_, rows_};
}

void Box2dLinks::add_contacts_of(b2Body& body, Box2dObstacles& obstacles,
                                 std::span<const std::uint32_t> attached) {
  for (b2ContactEdge* edge = body.GetContactList(); edge != nullptr; edge = edge->next) {
    b2Contact& contact = *edge->contact;
    const bool counts = contact.IsTouching() && contact.IsEnabled() && !contact.GetFixtureA()->IsSensor() &&
                        !contact.GetFixtureB()->IsSensor();
    if (!counts || contains(contacts_, &contact)) continue;
    contacts_.push_back(&contact);
    if (!contains(attached, obstacles.rigid_of(*edge->other))) add(contact, obstacles);
  }
}

void Box2dLinks::add_joints_of(b2Body& body, Box2dObstacles& obstacles,
                               std::span<const std::uint32_t> attached, float step) {
  for (b2JointEdge* edge = body.GetJointList(); edge != nullptr; edge = edge->next) {
    b2Joint& joint = *edge->joint;
    if (!joint.IsEnabled() || contains(joints_, &joint)) continue;
    joints_.push_back(&joint);
    if (contains(attached, obstacles.rigid_of(*edge->other))) continue;
    // Joints see where a body is, and have no part in how the program moves it there.
    const auto rigid_of = [&](b2Body& at) {
      return obstacles.is_moved_by_place(at) ? JointRow::kWorld : obstacles.rigid_of(at);
    };
    add_joint_rows(joint, rigid_of(*joint.GetBodyA()), rigid_of(*joint.GetBodyB()), step, rows_);
  }
}

/// Box2D's normals point from its first fixture to the second one.
void Box2dLinks::add(b2Contact& contact, Box2dObstacles& obstacles) {
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
