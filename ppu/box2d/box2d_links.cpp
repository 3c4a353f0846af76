#include "ppu/box2d/box2d_links.h"

#include <box2d/b2_collision.h>
#include <box2d/b2_contact.h>
#include <box2d/b2_joint.h>

#include <algorithm>
#include <cstddef>

#include "ppu/box2d/joint_rows_2d.h"

namespace softcell::ppu {
namespace {

bool contains(std::span<const std::uint32_t> rigids, std::uint32_t rigid) {
  return std::ranges::find(rigids, rigid) != rigids.end();
}

}  // namespace

bool Box2dLinks::is_looked_up(const b2Body& body, std::uint32_t rigid) const {
  return body.GetType() == b2_dynamicBody && !contains(attached_, rigid);
}

RigidLinks Box2dLinks::find(Box2dObstacles& obstacles, std::span<const std::uint32_t> attached, float step) {
  attached_ = attached;
  touches_.clear();
  rows_.clear();
  // Each body appends those that it touches or is joined to.
  std::uint32_t first = 0;
  for (int i = 0; i <= kFarthestTouch; ++i) {
    const auto for_each_new = [&](const auto& work) {
      for (std::uint32_t rigid = first; rigid < obstacles.bodies().size(); ++rigid)
        if (is_looked_up(*obstacles.bodies()[rigid], rigid)) work(rigid);
    };
    for_each_new([&](std::uint32_t rigid) { add_joints_of(rigid, obstacles, step); });
    const auto end = static_cast<std::uint32_t>(obstacles.bodies().size());
    for_each_new([&](std::uint32_t rigid) {
      if (rigid < end) add_contacts_of(rigid, obstacles);
    });
    first = end;
  }
  return {touches_, rows_};
}

/// Bodies are looked up in the order of their indices, so both bodies of a contact are only if the other one's turn is later.
void Box2dLinks::add_contacts_of(std::uint32_t rigid, Box2dObstacles& obstacles) {
  for (b2ContactEdge* edge = obstacles.bodies()[rigid]->GetContactList(); edge != nullptr;
       edge = edge->next) {
    b2Contact& contact = *edge->contact;
    const bool counts = contact.IsTouching() && contact.IsEnabled() && !contact.GetFixtureA()->IsSensor() &&
                        !contact.GetFixtureB()->IsSensor();
    if (!counts) continue;
    const std::uint32_t other = obstacles.rigid_of(*edge->other);
    if (contains(attached_, other) || (other < rigid && is_looked_up(*edge->other, other))) continue;
    add(contact, obstacles);
  }
}

void Box2dLinks::add_joints_of(std::uint32_t rigid, Box2dObstacles& obstacles, float step) {
  for (b2JointEdge* edge = obstacles.bodies()[rigid]->GetJointList(); edge != nullptr; edge = edge->next) {
    b2Joint& joint = *edge->joint;
    if (!joint.IsEnabled()) continue;
    const std::uint32_t other = obstacles.rigid_of(*edge->other);
    if (contains(attached_, other) || (other < rigid && is_looked_up(*edge->other, other))) continue;
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
