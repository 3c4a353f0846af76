#include "ppu/box2d/circle_body.h"

#include <box2d/b2_circle_shape.h>
#include <box2d/b2_contact.h>

#include <algorithm>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/box2d/box2d_soft_bodies.h"

namespace softcell::ppu {

CircleBody::CircleBody(b2World& world, SoftBody<2> soft, std::int16_t group)
    : Box2dBody(world, std::move(soft)), group_(group) {
  SC_ASSERT(group < 0, "the particles of a body have group {}, and would touch each other", group);
  add_particles();
}

CircleBody::~CircleBody() { remove_particles(); }

void CircleBody::remove_particles() {
  for (b2Body* const particle : particles_) world_.DestroyBody(particle);
  particles_.clear();
}

void CircleBody::add_particles() {
  of_number_.assign(model_->particles(), nullptr);
  for (const std::uint32_t particle : model_->outer()) add_particle(particle);
}

void CircleBody::exchange_particles() {
  remove_particles();
  add_particles();
}

void CircleBody::add_particle(std::uint32_t number) {
  b2BodyDef definition;
  definition.type = b2_dynamicBody;
  definition.position = to_box2d(soft_.position(number));
  definition.linearVelocity = to_box2d(soft_.velocities()[number]);
  definition.fixedRotation = true;
  // A single particle never sleeps: its neighbours would be pulled towards one that hangs still.
  definition.allowSleep = false;
  b2Body* const particle = world_.CreateBody(&definition);
  b2CircleShape circle;
  circle.m_radius = soft_.model().contact_radius(number);
  b2FixtureDef fixture;
  fixture.shape = &circle;
  fixture.density = 1;
  fixture.friction = soft_.settings().friction;
  fixture.restitution = soft_.settings().restitution;
  fixture.filter = own_filter();
  particle->CreateFixture(&fixture);
  // Set all members: braces alone leave the centre unset, as b2Vec2 has a constructor that does nothing.
  const b2MassData mass{.mass = soft_.model().masses()[number], .center = {0, 0}, .I = 0};
  particle->SetMassData(&mass);
  particles_.push_back(particle);
  of_number_[number] = particle;
}

b2Filter CircleBody::own_filter() const {
  b2Filter filter;
  filter.categoryBits = static_cast<std::uint16_t>(filter_.group);
  filter.maskBits = static_cast<std::uint16_t>(filter_.mask);
  filter.groupIndex = group_;
  return filter;
}

void CircleBody::set_filter(const CollisionFilter& filter) {
  Box2dBody::set_filter(filter);
  for (b2Body* const particle : particles_)
    for (b2Fixture* fixture = particle->GetFixtureList(); fixture != nullptr; fixture = fixture->GetNext())
      fixture->SetFilterData(own_filter());
}

/// Whether Box2D has woken a particle, because something that moves touches it, or what it touched is gone.
bool CircleBody::was_disturbed() const {
  return Box2dBody::was_disturbed() ||
         std::ranges::any_of(particles_, [](const b2Body* particle) { return particle->IsAwake(); }) ||
         has_lost_support();
}

/// Leaves out dynamic bodies that may not fall asleep: they are particles of other bodies, and wake the particles that they touch.
void CircleBody::remember_supports() {
  supports_.clear();
  for (const b2Body* const particle : particles_) {
    for (const b2ContactEdge* edge = particle->GetContactList(); edge != nullptr; edge = edge->next) {
      const b2Body& other = *edge->other;
      const bool is_rigid = other.GetType() != b2_dynamicBody || other.IsSleepingAllowed();
      if (edge->contact->IsTouching() && is_rigid &&
          std::ranges::find(supports_, &other, &Support::body) == supports_.end())
        supports_.push_back({&other, other.GetTransform()});
    }
  }
}

/// Whether the program has moved a body that a particle lies on, or made it a sensor. Box2D wakes no particle then, because it does not
/// look at contacts between two sleeping bodies. A body in a particle's list of contacts still exists.
bool CircleBody::has_lost_support() const {
  for (const b2Body* const particle : particles_) {
    for (const b2ContactEdge* edge = particle->GetContactList(); edge != nullptr; edge = edge->next) {
      const auto support = std::ranges::find(supports_, edge->other, &Support::body);
      if (support == supports_.end()) continue;
      if (!is_same(edge->other->GetTransform(), support->pose) || edge->contact->GetFixtureA()->IsSensor() ||
          edge->contact->GetFixtureB()->IsSensor())
        return true;
    }
  }
  return false;
}

void CircleBody::shift(const Eigen::Vector2f& by) {
  Box2dBody::shift(by);
  for (Support& support : supports_) support.pose.p += to_box2d(by);
}

bool CircleBody::was_pushed() const {
  if (soft_.asleep()) return was_disturbed();
  const auto outer = soft_.model().outer();
  for (std::size_t i = 0; i < outer.size(); ++i) {
    if (to_eigen(particles_[i]->GetPosition()) != soft_.position(outer[i]) ||
        to_eigen(particles_[i]->GetLinearVelocity()) != soft_.velocities()[outer[i]])
      return true;
  }
  return false;
}

void CircleBody::place_particle(std::size_t particle) {
  if (b2Body* const outer = of_number_[particle]) outer->SetTransform(to_box2d(soft_.position(particle)), 0);
}

void CircleBody::set_particles_awake(bool awake) {
  supports_.clear();
  if (!awake) remember_supports();
  for (b2Body* const particle : particles_) particle->SetAwake(awake);
}

void CircleBody::hand_over(float step) {
  SC_ASSERT(step > 0, "a time step of {} s", step);
  if (soft_.asleep()) return;
  soft_.limit_speed(Box2dSoftBodies::kMaxTravelInCells * soft_.model().lattice().spacing / step);
  const auto outer = soft_.model().outer();
  for (std::size_t i = 0; i < outer.size(); ++i)
    particles_[i]->SetLinearVelocity(to_box2d(soft_.velocities()[outer[i]]));
}

void CircleBody::end_step(float step) {
  if (soft_.asleep()) {
    if (!was_disturbed()) return;
    wake();
    gather_particles();  // Box2D has moved only the touched particles; inner ones stay in place
    return;
  }
  gather_particles();
  soft_.advance_inner(step, to_eigen(world_.GetGravity()));
  soft_.keep_inner_inside();
}

void CircleBody::gather_particles() {
  const auto outer = soft_.model().outer();
  SC_ASSERT(particles_.size() == outer.size(), "{} bodies of Box2D for {} particles", particles_.size(),
            outer.size());
  for (std::size_t i = 0; i < outer.size(); ++i) {
    soft_.set_particle(outer[i], to_eigen(particles_[i]->GetPosition()),
                       to_eigen(particles_[i]->GetLinearVelocity()));
  }
}

/// The user has changed the body: moves its particles in Box2D.
void CircleBody::place_particles() {
  const auto outer = soft_.model().outer();
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const b2Vec2 position = to_box2d(soft_.position(outer[i]));
    if (position != particles_[i]->GetPosition()) particles_[i]->SetTransform(position, 0);
    particles_[i]->SetLinearVelocity(to_box2d(soft_.velocities()[outer[i]]));
  }
  if (particles_.empty()) return;
  const b2Fixture& now = *particles_.front()->GetFixtureList();
  if (now.GetFriction() == soft_.settings().friction && now.GetRestitution() == soft_.settings().restitution)
    return;
  for (b2Body* const particle : particles_) {
    particle->GetFixtureList()->SetFriction(soft_.settings().friction);
    particle->GetFixtureList()->SetRestitution(soft_.settings().restitution);
    for (b2ContactEdge* edge = particle->GetContactList(); edge != nullptr; edge = edge->next) {
      edge->contact->ResetFriction();  // contacts keep their first values
      edge->contact->ResetRestitution();
    }
  }
}

}  // namespace softcell::ppu
