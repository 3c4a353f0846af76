#include "ppu/box2d/rest.h"

#include <box2d/b2_contact.h>
#include <box2d/b2_joint.h>

#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

template <class Body>
void add_once(std::vector<Body*>& bodies, Body& body) {
  if (std::ranges::find(bodies, &body) == bodies.end()) bodies.push_back(&body);
}

}  // namespace

bool Rest::rests(const Box2dBody& body, const SleepSettings& settings) const {
  return body.still_for() >= settings.seconds;
}

bool Rest::rests(const b2Body& body, const SleepSettings& settings) const {
  if (body.GetType() == b2_kinematicBody) return stands_still(body);
  const bool is_slow = body.GetLinearVelocity().Length() < settings.speed &&
                       std::abs(body.GetAngularVelocity()) < settings.speed;
  return is_slow && world_.GetAllowSleeping() && body.IsSleepingAllowed();
}

/// Adds a body to the group, unless it sleeps or never moves: such a body keeps no other awake.
void Rest::add(b2Body& body) {
  if (Box2dBody* const soft = soft_body_of_(body))
    add(*soft);
  else if (body.GetType() != b2_staticBody && body.IsEnabled() && body.IsAwake())
    add_once(rigid_, body);
}

void Rest::add(Box2dBody& body) {
  if (!body.soft().asleep()) add_once(soft_, body);
}

void Rest::add_neighbours(b2Body& body, const SoftNeighbours& beside) {
  for (const b2ContactEdge* edge = body.GetContactList(); edge != nullptr; edge = edge->next)
    if (edge->contact->IsTouching()) add(*edge->other);
  for (const b2JointEdge* edge = body.GetJointList(); edge != nullptr; edge = edge->next) add(*edge->other);
  for (const auto& [soft, rigid] : beside.rigid)
    if (rigid == &body) add(*soft);
}

void Rest::add_neighbours(Box2dBody& body, const SoftNeighbours& beside) {
  for (b2Body* const particle : body.particles()) add_neighbours(*particle, beside);
  for (const auto& [soft, rigid] : beside.rigid)
    if (soft == &body) add(*rigid);
  for (const auto& [a, b] : beside.soft) {
    if (a == &body) add(*b);
    if (b == &body) add(*a);
  }
}

std::span<Box2dBody* const> Rest::settle(Box2dBody& body, const SleepSettings& settings,
                                         const SoftNeighbours& beside) {
  SC_ASSERT(!body.soft().asleep(), "a body that has been still for {} s already sleeps", body.still_for());
  soft_.assign(1, &body);
  rigid_.clear();
  for (std::size_t soft = 0, rigid = 0; soft < soft_.size() || rigid < rigid_.size();) {
    if (soft < soft_.size()) {
      Box2dBody& next = *soft_[soft++];
      if (!rests(next, settings)) return {};
      add_neighbours(next, beside);
    } else {
      b2Body& next = *rigid_[rigid++];
      if (!rests(next, settings)) return {};
      if (next.GetType() != b2_kinematicBody) add_neighbours(next, beside);
    }
  }
  for (Box2dBody* const resting : soft_) resting->fall_asleep();
  for (b2Body* const resting : rigid_)
    if (resting->GetType() == b2_dynamicBody) resting->SetAwake(false);  // bodies of other types would stop
  return soft_;
}

}  // namespace softcell::ppu
