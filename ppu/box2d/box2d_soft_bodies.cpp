#include "softcell/box2d/box2d_soft_bodies.h"

#include <box2d/b2_body.h>
#include <box2d/b2_circle_shape.h>
#include <box2d/b2_fixture.h>

#include <algorithm>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;

b2Vec2 to_box2d(const Vector2f& v) { return {v.x(), v.y()}; }
Vector2f to_eigen(const b2Vec2& v) { return {v.x, v.y}; }

/// One soft body and the b2Bodies of its outer particles, in the order of SoftBodyModel<2>::outer().
class CoupledBody {
 public:
  /// @param group  below 0, no other body's: Box2D makes no contacts within a negative group.
  CoupledBody(b2World& world, std::shared_ptr<const SoftBodyModel<2>> model, const Vector2f& position,
              std::int16_t group)
      : world_(world), soft_(std::move(model), position), group_(group) {
    for (const std::uint32_t particle : soft_.model().outer()) add_particle(particle);
  }
  ~CoupledBody() {
    for (b2Body* particle : particles_) world_.DestroyBody(particle);
  }
  CoupledBody(const CoupledBody&) = delete;
  CoupledBody& operator=(const CoupledBody&) = delete;

  SoftBody<2>& soft() { return soft_; }
  const SoftBody<2>& soft() const { return soft_; }
  std::int16_t group() const { return group_; }
  std::span<b2Body* const> particles() const { return particles_; }

  /// Whether what is known of its rotations is of no use since the last step.
  bool was_reset() const { return soft_.resets() != seen_resets_; }

  // Before Box2D's step: what its user and Box2D have done, then shape matching, then the new velocities.

  void begin_step() {
    if (soft_.revision() != seen_revision_) {
      place_particles();
    } else {
      gather();  // of velocities, mostly: the caller may have pushed particles
    }
  }
  void hand_over(float step) {
    soft_.limit_speed(Box2dSoftBodies::kMaxTravelInCells * soft_.model().lattice().spacing / step);
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      particles_[i]->SetLinearVelocity(to_box2d(soft_.velocities()[outer[i]]));
    }
  }

  /// After it: outer particles are taken over, inner ones follow.
  void end_step(float step) {
    gather();
    soft_.advance_inner(step, to_eigen(world_.GetGravity()));
    soft_.keep_inner_inside();
  }

 private:
  void add_particle(std::uint32_t number) {
    b2BodyDef definition;
    definition.type = b2_dynamicBody;
    definition.position = to_box2d(soft_.positions()[number]);
    definition.fixedRotation = true;
    // A particle alone never sleeps: its neighbours would be pulled towards one that hangs still.
    definition.allowSleep = false;
    b2Body* const particle = world_.CreateBody(&definition);
    b2CircleShape circle;
    circle.m_radius = soft_.model().contact_radius();
    b2FixtureDef fixture;
    fixture.shape = &circle;
    fixture.density = 1;
    fixture.friction = soft_.model().settings().friction;
    fixture.restitution = 0;
    fixture.filter.groupIndex = group_;
    particle->CreateFixture(&fixture);
    b2MassData mass{};
    mass.mass = soft_.model().masses()[number];
    particle->SetMassData(&mass);
    particles_.push_back(particle);
  }

  void gather() {
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      soft_.set_particle(outer[i], to_eigen(particles_[i]->GetPosition()),
                         to_eigen(particles_[i]->GetLinearVelocity()));
    }
  }

  /// The body was moved by its user: so are its particles.
  void place_particles() {
    seen_revision_ = soft_.revision();
    seen_resets_ = soft_.resets();
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      const b2Vec2 position = to_box2d(soft_.positions()[outer[i]]);
      if (position != particles_[i]->GetPosition()) particles_[i]->SetTransform(position, 0);
      particles_[i]->SetLinearVelocity(to_box2d(soft_.velocities()[outer[i]]));
    }
  }

  b2World& world_;
  SoftBody<2> soft_;
  std::int16_t group_;
  std::vector<b2Body*> particles_;
  std::uint32_t seen_revision_ = 0, seen_resets_ = 0;
};

}  // namespace

struct Box2dSoftBodies::Impl {
  Impl(b2World& w, SoftBodySolver<2>* other) : world(w), solver(other ? *other : ppu) {}
  ~Impl() {
    for (SoftBody<2>* const body : soft) solver.forget(*body);
  }

  template <typename Work>
  void timed(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    spent += std::chrono::steady_clock::now() - begin;
  }

  void begin_step(float step) {
    for (const auto& body : bodies) {
      if (body->was_reset()) solver.forget(body->soft());
      body->begin_step();
    }
    solver.kick(soft, step);
    const auto waiting = std::chrono::steady_clock::now();
    solver.finish();
    waited += std::chrono::steady_clock::now() - waiting;
    for (const auto& body : bodies) body->hand_over(step);
  }

  /// The negative group nearest to 0 that no body has. @throws std::runtime_error  32,768 bodies are too
  /// many.
  std::int16_t free_group() const {
    for (int group = -1; group >= std::numeric_limits<std::int16_t>::min(); --group) {
      if (std::none_of(bodies.begin(), bodies.end(),
                       [&](const auto& body) { return body->group() == group; })) {
        return static_cast<std::int16_t>(group);
      }
    }
    throw std::runtime_error(
        "a Box2D world has at most 32768 soft bodies: there are no more collision groups");
  }

  b2World& world;
  PpuSolver<2> ppu;
  SoftBodySolver<2>& solver;
  std::vector<std::unique_ptr<CoupledBody>> bodies;
  std::vector<SoftBody<2>*> soft;  // of `bodies`
  std::unordered_map<const b2Body*, Particle> particles;
  std::chrono::nanoseconds spent{0}, waited{0};
};

Box2dSoftBodies::Box2dSoftBodies(b2World& world) : impl_(std::make_unique<Impl>(world, nullptr)) {}
Box2dSoftBodies::Box2dSoftBodies(b2World& world, SoftBodySolver<2>& solver)
    : impl_(std::make_unique<Impl>(world, &solver)) {}
Box2dSoftBodies::~Box2dSoftBodies() = default;

SoftBody<2>& Box2dSoftBodies::add(std::shared_ptr<const SoftBodyModel<2>> model, const Vector2f& position) {
  CoupledBody& added = *impl_->bodies.emplace_back(
      std::make_unique<CoupledBody>(impl_->world, std::move(model), position, impl_->free_group()));
  const auto outer = added.soft().model().outer();
  for (std::size_t i = 0; i < outer.size(); ++i) {
    impl_->particles[added.particles()[i]] = {&added.soft(), outer[i]};
  }
  impl_->soft.push_back(&added.soft());
  return added.soft();
}

void Box2dSoftBodies::remove(const SoftBody<2>& body) {
  const auto found = std::find_if(impl_->bodies.begin(), impl_->bodies.end(),
                                  [&](const auto& coupled) { return &coupled->soft() == &body; });
  if (found == impl_->bodies.end()) {
    throw std::invalid_argument("the soft body to be removed is not in this world");
  }
  for (const b2Body* particle : (*found)->particles()) impl_->particles.erase(particle);
  impl_->solver.forget(body);
  impl_->soft.erase(impl_->soft.begin() + (found - impl_->bodies.begin()));
  impl_->bodies.erase(found);
}

void Box2dSoftBodies::step(float step, int velocity_iterations, int position_iterations) {
  begin_step(step);
  impl_->world.Step(step, velocity_iterations, position_iterations);
  end_step(step);
}

void Box2dSoftBodies::begin_step(float step) {
  impl_->timed([&] { impl_->begin_step(step); });
}

void Box2dSoftBodies::end_step(float step) {
  impl_->timed([&] {
    for (const auto& body : impl_->bodies) body->end_step(step);
  });
}

std::size_t Box2dSoftBodies::size() const { return impl_->bodies.size(); }
SoftBody<2>& Box2dSoftBodies::operator[](std::size_t index) { return impl_->bodies.at(index)->soft(); }
const SoftBody<2>& Box2dSoftBodies::operator[](std::size_t index) const {
  return impl_->bodies.at(index)->soft();
}

Box2dSoftBodies::Particle Box2dSoftBodies::particle_of(const b2Body& body) const {
  const auto found = impl_->particles.find(&body);
  return found == impl_->particles.end() ? Particle{} : found->second;
}

std::chrono::nanoseconds Box2dSoftBodies::time_spent() const { return impl_->spent; }
std::chrono::nanoseconds Box2dSoftBodies::time_waited() const { return impl_->waited; }

}  // namespace softcell::ppu
