#include "ppu/box2d/box2d_body.h"

#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {

// Box2D 2.4 has no function that returns the forces which a program has applied. An explicit instantiation may name private members
// ([temp.spec] in the C++ standard), and the friends that it defines return them. They are found by their arguments.
template <b2Vec2 b2Body::*Force, float b2Body::*Torque>
struct AppliedForces {
  friend b2Vec2 applied_force(const b2Body& body) { return body.*Force; }
  friend float applied_torque(const b2Body& body) { return body.*Torque; }
};
template struct AppliedForces<&b2Body::m_force, &b2Body::m_torque>;
b2Vec2 applied_force(const b2Body& body);  // N
float applied_torque(const b2Body& body);  // N m

using Eigen::Vector2f;

bool has_body(const b2World& world, const b2Body* body) {
  for (const b2Body* there = world.GetBodyList(); there != nullptr; there = there->GetNext())
    if (there == body) return true;
  return false;
}

float inverse_mass_of(const b2Body& body) {
  SC_ASSERT(body.GetType() == b2_dynamicBody, "the mass of a body of type {}",
            static_cast<int>(body.GetType()));
  return body.GetMass() > 0 ? 1 / body.GetMass() : 0;
}

float inverse_inertia_of(const b2Body& body) {
  SC_ASSERT(body.GetType() == b2_dynamicBody, "the inertia of a body of type {}",
            static_cast<int>(body.GetType()));
  // Box2D gives the inertia about the body's origin.
  const float inertia = body.GetInertia() - body.GetMass() * body.GetLocalCenter().LengthSquared();
  return !body.IsFixedRotation() && inertia > 0 ? 1 / inertia : 0;
}

VelocityGain velocity_gain(const b2Body& body, const b2Vec2& gravity, float step) {
  if (body.GetType() != b2_dynamicBody || body.GetMass() <= 0) return {};
  return {step * body.GetGravityScale() * gravity + step * inverse_mass_of(body) * applied_force(body),
          step * inverse_inertia_of(body) * applied_torque(body)};
}

Box2dBody::Box2dBody(b2World& world, SoftBody<2> soft)
    : world_(world), soft_(std::move(soft)), model_(soft_.shared_model()) {}

b2Body* Box2dBody::particle(std::uint32_t number) const {
  SC_ASSERT(number < soft_.positions().size(), "particle {} of {}", number, soft_.positions().size());
  return nullptr;
}

void Box2dBody::follow_model() {
  if (!is_of_other_model()) return;
  SC_ASSERT(!world_.IsLocked(), "{} particles are exchanged within a step of Box2D", particles().size());
  model_ = soft_.shared_model();
  exchange_particles();
}

bool Box2dBody::was_disturbed() const { return world_.GetGravity() != gravity_asleep_; }

void Box2dBody::begin_step() {
  if (soft_.asleep() && (was_changed() || was_disturbed())) wake();
  if (!was_changed()) return take_over_particles();
  seen_revision_ = soft_.revision();
  seen_resets_ = soft_.resets();
  place_particles();
}

void Box2dBody::shift(const Eigen::Vector2f& by) {
  const bool was_changed_before = was_changed();
  soft_.translate(by);
  if (!was_changed_before) seen_revision_ = soft_.revision();
}

void Box2dBody::take_over_particles() {
  if (!was_changed() && !soft_.asleep()) gather_particles();
}

void Box2dBody::move_particle(std::size_t particle, const Vector2f& way) {
  SC_ASSERT(particle < soft_.positions().size() && way.allFinite(),
            "particle {} of {} is moved by ({}, {}) m", particle, soft_.positions().size(), way.x(), way.y());
  soft_.set_particle(particle, soft_.position(particle) + way, soft_.velocities()[particle]);
  place_particle(particle);
}

void Box2dBody::end_step(float /*step*/) {
  if (soft_.asleep() && was_disturbed()) wake();
}

void Box2dBody::count_stillness(float step, float speed) {
  stillness_.count(step, real_speed_.value_or(soft_.mean_speed()), speed);
}

void Box2dBody::fall_asleep() {
  SC_ASSERT(!soft_.asleep(), "a body falls asleep that has been still for {} s and sleeps",
            stillness_.seconds());
  for (std::size_t i = 0; i < soft_.velocities().size(); ++i) soft_.set_velocity(i, Vector2f::Zero());
  set_particles_awake(false);  // Box2D stops them, too
  gravity_asleep_ = world_.GetGravity();
  soft_.set_asleep(true);
}

void Box2dBody::wake() {
  stillness_.begin();
  soft_.set_asleep(false);
  set_particles_awake(true);
}

}  // namespace softcell::ppu
