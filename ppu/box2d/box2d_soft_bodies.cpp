#include "softcell/box2d/box2d_soft_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ppu/bodies/step_ahead.h"
#include "ppu/box2d/box2d_attachments.h"
#include "ppu/box2d/box2d_body.h"
#include "ppu/box2d/rest.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Vector2f;

struct Box2dSoftBodies::Impl {
  /// @param solver  a SoftBodySolver<2>, or the pointer that owns one
  template <typename Solver>
  Impl(b2World& w, Solver&& solver)
      : world(w),
        rest(w, [this](const b2Body& body) { return soft_body_of(body); }),
        attachments(w, [this](const b2Body& body) { return soft_body_of(body); }),
        solve(std::forward<Solver>(solver)) {}

  template <typename Work>
  void timed(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    spent += std::chrono::steady_clock::now() - begin;
  }

  void begin_step(float step) {
    SC_ASSERT(step > 0 && std::isfinite(step), "a time step of {} s", step);
    SC_ASSERT(!world.IsLocked(), "a step of {} s within a step of Box2D", step);
    if (!solve.has_begun(step) || std::ranges::any_of(bodies, [](const auto& body) {
          return body->was_changed() || body->was_pushed();
        })) {
      solve.drop();
      for (const auto& body : bodies) {
        if (body->was_reset()) solve.forget(body->soft());
        body->begin_step();
      }
    }
    waited += solve.finish(step);
    attachments.solve(bodies, step);
    for (const auto& body : bodies) body->hand_over(step);
  }

  void end_step(float step) {
    SC_ASSERT(step > 0 && !world.IsLocked(), "the end of a step of {} s within a step of Box2D, or of none",
              step);
    for (const auto& body : bodies) body->end_step(step);
    if (!sleep) return;
    for (const auto& body : bodies)
      if (!body->soft().asleep() && !attachments.holds(*body)) body->count_stillness(step, sleep->speed);
    for (const auto& body : bodies)
      if (!body->soft().asleep()) rest.settle(*body, *sleep);
  }

  /// Null for a b2Body that is no particle.
  Box2dBody* soft_body_of(const b2Body& body) const {
    const auto found = particles.find(&body);
    return found == particles.end() ? nullptr : found->second.body;
  }

  /// @throws std::invalid_argument
  Box2dBody& find(const SoftBody<2>& body) {
    const auto found =
        std::ranges::find_if(bodies, [&](const auto& coupled) { return &coupled->soft() == &body; });
    if (found == bodies.end())
      throw std::invalid_argument("the soft body to be attached is not in this world");
    return **found;
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

  /// What a b2Body stands for.
  struct OneParticle {
    Box2dBody* body;
    std::size_t number;
  };

  b2World& world;
  std::vector<std::unique_ptr<Box2dBody>> bodies;
  std::unordered_map<const b2Body*, OneParticle> particles;
  Rest rest;
  Box2dAttachments attachments;
  std::optional<SleepSettings> sleep;
  std::chrono::nanoseconds spent{0}, waited{0};
  StepAhead<2> solve;  // of `bodies`
};

Box2dSoftBodies::Box2dSoftBodies(b2World& world)
    : impl_(std::make_unique<Impl>(world, std::make_unique<PpuSolver<2>>())) {}
Box2dSoftBodies::Box2dSoftBodies(b2World& world, SolverFactory& solvers)
    : impl_(std::make_unique<Impl>(world, solvers.make_solver_2d())) {}
Box2dSoftBodies::Box2dSoftBodies(b2World& world, SoftBodySolver<2>& solver)
    : impl_(std::make_unique<Impl>(world, solver)) {}
Box2dSoftBodies::~Box2dSoftBodies() = default;

SoftBody<2>& Box2dSoftBodies::add(std::shared_ptr<const SoftBodyModel<2>> model, const Vector2f& position) {
  SC_ASSERT(model != nullptr && position.allFinite(), "a soft body {} a model, at ({}, {})",
            model ? "with" : "without", position.x(), position.y());
  SC_ASSERT(!impl_->world.IsLocked(), "add() of body {} within a step of Box2D", impl_->bodies.size());
  impl_->solve.drop();
  Box2dBody& added = *impl_->bodies.emplace_back(
      std::make_unique<Box2dBody>(impl_->world, std::move(model), position, impl_->free_group()));
  const auto outer = added.soft().model().outer();
  for (std::size_t i = 0; i < outer.size(); ++i) impl_->particles[added.particles()[i]] = {&added, outer[i]};
  impl_->solve.add(added.soft());
  return added.soft();
}

void Box2dSoftBodies::remove(const SoftBody<2>& body) {
  const auto found = std::find_if(impl_->bodies.begin(), impl_->bodies.end(),
                                  [&](const auto& coupled) { return &coupled->soft() == &body; });
  if (found == impl_->bodies.end()) {
    throw std::invalid_argument("the soft body to be removed is not in this world");
  }
  SC_ASSERT(!impl_->world.IsLocked(), "remove() of one of {} bodies within a step of Box2D",
            impl_->bodies.size());
  impl_->solve.remove(body);
  impl_->attachments.forget(**found);
  for (const b2Body* particle : (*found)->particles()) impl_->particles.erase(particle);
  impl_->bodies.erase(found);
}

AttachmentId Box2dSoftBodies::attach(const SoftBody<2>& body, const Patch<2>& patch,
                                     const AttachmentSettings<2>& settings) {
  return impl_->attachments.add(impl_->find(body), patch, nullptr, settings);
}
AttachmentId Box2dSoftBodies::attach(const SoftBody<2>& body, const Patch<2>& patch, b2Body& rigid,
                                     const AttachmentSettings<2>& settings) {
  return impl_->attachments.add(impl_->find(body), patch, &rigid, settings);
}
AttachmentId Box2dSoftBodies::attach(const SoftBody<2>& body, const Patch<2>& patch, const SoftBody<2>& other,
                                     const Patch<2>& other_patch, const AttachmentSettings<2>& settings) {
  return impl_->attachments.add(impl_->find(body), patch, impl_->find(other), other_patch, settings);
}
void Box2dSoftBodies::detach(AttachmentId id) { impl_->attachments.remove(id); }
void Box2dSoftBodies::move_attachment(AttachmentId id, const Vector2f& position, float angle, float seconds) {
  impl_->attachments.move(id, position, angle, seconds);
}
std::optional<AttachmentState<2>> Box2dSoftBodies::attachment(AttachmentId id) const {
  return impl_->attachments.state(id);
}
std::optional<AttachmentEnds<2>> Box2dSoftBodies::attachment_ends(AttachmentId id) const {
  return impl_->attachments.ends(id);
}
std::vector<EndedAttachment> Box2dSoftBodies::take_ended_attachments() {
  return impl_->attachments.take_ended();
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
  impl_->timed([&] { impl_->end_step(step); });
}

void Box2dSoftBodies::begin_ahead(float step) {
  SC_ASSERT(step > 0 && std::isfinite(step), "a time step of {} s", step);
  impl_->timed([&] { impl_->solve.begin(step); });
}

void Box2dSoftBodies::let_sleep(const std::optional<SleepSettings>& settings) {
  SC_ASSERT(!settings || (settings->speed >= 0 && settings->seconds >= 0),
            "bodies sleep that were slower than {} m/s for {} s", settings->speed, settings->seconds);
  impl_->solve.drop();
  impl_->sleep = settings;
  if (settings) return;
  for (const auto& body : impl_->bodies)
    if (body->soft().asleep()) body->wake();
}

std::size_t Box2dSoftBodies::size() const { return impl_->bodies.size(); }
SoftBody<2>& Box2dSoftBodies::operator[](std::size_t index) { return impl_->bodies.at(index)->soft(); }
const SoftBody<2>& Box2dSoftBodies::operator[](std::size_t index) const {
  return impl_->bodies.at(index)->soft();
}

Box2dSoftBodies::Particle Box2dSoftBodies::particle_of(const b2Body& body) const {
  const auto found = impl_->particles.find(&body);
  if (found == impl_->particles.end()) return {};
  return {&found->second.body->soft(), found->second.number};
}

std::chrono::nanoseconds Box2dSoftBodies::time_spent() const { return impl_->spent; }
std::chrono::nanoseconds Box2dSoftBodies::time_waited() const { return impl_->waited; }

}  // namespace softcell::ppu
