#include "ppu/box2d/box2d_attachments.h"

#include <box2d/b2_fixture.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/attachments/attachment_patch.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;

constexpr int kIterations = 20;  // of attachments that share bodies

AttachmentFrame<2> frame_of(const b2Transform& pose) {
  AttachmentFrame<2> frame;
  frame.position = frame.end_position = to_eigen(pose.p);
  frame.rotation << pose.q.c, -pose.q.s, pose.q.s, pose.q.c;
  frame.end_rotation = frame.rotation;
  return frame;
}

bool is_awake(const Box2dBody& body) { return !body.soft().asleep(); }

/// Whether a rigid body keeps what is attached to it awake. @param pose  that it had before
bool is_disturbed(const b2Body& rigid, const b2Transform& pose) {
  return is_simulated(rigid) ? rigid.IsAwake() : !is_same(rigid.GetTransform(), pose) || !stands_still(rigid);
}

}  // namespace

bool Box2dAttachments::may_touch(const b2Body& a, const b2Body& b) const {
  if (links_.empty()) return true;
  const Box2dBody* const soft_a = soft_body_of_(a);
  const Box2dBody* const soft_b = soft_body_of_(b);
  const auto is = [](const Link& link, const Box2dBody* soft, const Box2dBody* other, const b2Body* rigid) {
    return soft != nullptr && link.a == soft &&
           (other != nullptr ? link.b == other : link.rigid != nullptr && link.rigid == rigid);
  };
  return std::none_of(links_.begin(), links_.end(), [&](const auto& link) {
    return !link->touch && (is(*link, soft_a, soft_b, &b) || is(*link, soft_b, soft_a, &a));
  });
}

bool Box2dAttachments::parts(const Box2dBody& body, const b2Body& rigid) const {
  return std::ranges::any_of(
      links_, [&](const auto& link) { return !link->touch && link->a == &body && link->rigid == &rigid; });
}

std::uint32_t Box2dAttachments::index_of(const Box2dBody* body,
                                         std::span<const std::unique_ptr<Box2dBody>> bodies) {
  const auto found = std::ranges::find_if(bodies, [&](const auto& other) { return other.get() == body; });
  SC_ASSERT(found != bodies.end(), "an attached body is none of {}", bodies.size());
  return static_cast<std::uint32_t>(found - bodies.begin());
}

/// Makes Box2D ask the filter again about everything that touches the bodies of a link.
void Box2dAttachments::refilter(const Link& link) {
  if (link.touch || link.a->particles().empty()) return;
  filter_.install();
  for (b2Body* const particle : link.a->particles())
    for (b2Fixture* fixture = particle->GetFixtureList(); fixture != nullptr; fixture = fixture->GetNext())
      fixture->Refilter();
}

void Box2dAttachments::wake(const Link& link) {
  for (Box2dBody* const body : {link.a, link.b})
    if (body != nullptr && body->soft().asleep()) body->wake();
  if (link.rigid != nullptr) link.rigid->SetAwake(true);
}

/// What is attached falls asleep together, so something has disturbed what is awake or has moved.
void Box2dAttachments::wake_disturbed() {
  for (bool has_woken = true; has_woken;) {
    has_woken = false;
    for (const auto& link : links_) {
      const bool has_awake = is_awake(*link->a) || (link->b != nullptr && is_awake(*link->b)) ||
                             (link->rigid != nullptr && is_disturbed(*link->rigid, link->pose));
      const bool has_sleepers =
          !is_awake(*link->a) || (link->b != nullptr && !is_awake(*link->b)) ||
          (link->rigid != nullptr && is_simulated(*link->rigid) && !link->rigid->IsAwake());
      if (!has_awake || !has_sleepers) continue;
      wake(*link);
      has_woken = true;
    }
  }
  for (const auto& link : links_) {
    if (link->rigid == nullptr) continue;
    link->pose = link->rigid->GetTransform();
    // Box2D would put it to sleep by itself, and stop it.
    if (link->rigid->GetType() == b2_dynamicBody && is_awake(*link->a)) link->rigid->SetAwake(true);
  }
}

AttachmentId Box2dAttachments::add(Box2dBody& body, const Patch<2>& patch, b2Body* rigid,
                                   const AttachmentSettings<2>& settings) {
  validate(settings);
  AttachmentSettings<2> full = settings;
  const PatchParticles<2> particles = particles_of(patch, body.soft());
  AttachmentFrame<2> frame;
  if (rigid != nullptr) {
    if (!has_body(world_, rigid))
      throw std::invalid_argument("the rigid body of an attachment is not in this world");
    if (soft_body_of_(*rigid) != nullptr)
      throw std::invalid_argument("the rigid body of an attachment is a particle of a soft one");
    frame = frame_of(rigid->GetTransform());
    if (settings.kind == AttachmentKind::kRope && !full.point) full.point = to_eigen(rigid->GetWorldCenter());
  } else {
    frame = frame_in_world(full, particles);
  }
  Link link{.a = &body,
            .rigid = rigid,
            .touch = touches(full),
            .rows = AttachmentRows<2>(full, particles, frame),
            .hold = {.frame = frame, .goal = frame.position}};
  if (rigid != nullptr) link.pose = rigid->GetTransform();
  return add(std::move(link));
}

AttachmentId Box2dAttachments::add(Box2dBody& body, const Patch<2>& patch, Box2dBody& other,
                                   const Patch<2>& other_patch, const AttachmentSettings<2>& settings) {
  validate(settings);
  if (&body == &other) throw std::invalid_argument("a soft body cannot be attached to itself");
  return add(Link{.a = &body,
                  .b = &other,
                  .touch = touches(settings),
                  .rows = AttachmentRows<2>(settings, particles_of(patch, body.soft()),
                                            particles_of(other_patch, other.soft())),
                  .hold = {}});
}

AttachmentId Box2dAttachments::add(Link link) {
  SC_ASSERT(!world_.IsLocked(), "an attachment of {} particles is made within a step of Box2D",
            link.a->particles().size());
  end_gone();
  const Link& added = links_.add(std::move(link));
  wake(added);
  refilter(added);
  return added.id;
}

void Box2dAttachments::release(const Link& link) {
  wake(link);
  refilter(link);
}

void Box2dAttachments::remove(AttachmentId id) {
  end_gone();
  links_.at(id);  // or throws
  for (const auto& link : links_.take([&](const Link& other) { return other.id == id; })) release(*link);
}

void Box2dAttachments::move(AttachmentId id, const Vector2f& position, float angle, float seconds) {
  Link& link = links_.to_world(id);
  if (!position.allFinite() || !std::isfinite(angle))
    throw std::invalid_argument(
        "an attachment is moved to a place, or turned by an angle, that is not finite");
  link.hold.move(position, angle, seconds);
  wake(link);
}

void Box2dAttachments::shift(const Vector2f& by) {
  for (const auto& link : links_) {
    link->hold.frame.position += by;
    link->hold.frame.end_position += by;
    link->hold.goal += by;
    link->pose.p += to_box2d(by);
  }
}

std::optional<AttachmentState<2>> Box2dAttachments::state(AttachmentId id) const {
  if (const Link* const link = links_.find(id)) return link->rows.state();
  return std::nullopt;
}

std::optional<AttachmentEnds<2>> Box2dAttachments::ends(AttachmentId id) const {
  const Link* const link = links_.find(id);
  if (link == nullptr || (link->rigid != nullptr && !has_body(world_, link->rigid))) return std::nullopt;
  return link->rows.ends(link->a->soft().positions(),
                         link->b != nullptr ? link->b->soft().positions() : std::span<const Vector2f>(),
                         link->rigid != nullptr ? frame_of(link->rigid->GetTransform()) : link->hold.frame);
}

void Box2dAttachments::forget(const Box2dBody& body) {
  end_gone();
  links_.end_those_of(body, [&](const Link& link) { release(link); });
}

void Box2dAttachments::follow_pieces(const Box2dBody& body, std::span<const Piece> pieces,
                                     std::span<const std::vector<std::uint32_t>> vanished) {
  links_.follow_pieces(body, pieces, vanished, [&](const Link& link) { release(link); });
}

bool Box2dAttachments::holds(const Box2dBody& body) const {
  return std::ranges::any_of(links_, [&](const auto& link) { return link->a == &body || link->b == &body; });
}

bool Box2dAttachments::is_being_moved(const Box2dBody& body) const {
  return std::ranges::any_of(links_, [&](const auto& link) { return link->a == &body && link->hold.moves; });
}

void Box2dAttachments::append_neighbours(SoftNeighbours& neighbours) {
  end_gone();
  for (const auto& link : links_) {
    if (link->b != nullptr) neighbours.soft.emplace_back(link->a, link->b);
    if (link->rigid != nullptr) neighbours.rigid.emplace_back(link->a, link->rigid);
  }
}

void Box2dAttachments::end_gone() {
  links_.end_gone([&](const Link& link) { return has_body(world_, link.rigid); },
                  [&](const Link& link) { release(link); });
}

void Box2dAttachments::lay_out(const Box2dBody& body, InStep& in_step, float step) const {
  const SoftBody<2>& soft = body.soft();
  const Vector2f fall = step * to_eigen(world_.GetGravity());
  in_step.velocities.assign(soft.velocities().begin(), soft.velocities().end());
  for (Vector2f& v : in_step.velocities) v += fall;
  in_step.pushes.assign(in_step.velocities.size(), Vector2f::Zero());
  in_step.inverse_masses.clear();
  for (const float mass : soft.model().masses())
    in_step.inverse_masses.push_back(soft.asleep() ? 0 : 1 / mass);
}

void Box2dAttachments::finish(Box2dBody& body, const InStep& in_step, float step) const {
  if (body.soft().asleep()) return;
  const Vector2f fall = step * to_eigen(world_.GetGravity());
  for (std::size_t i = 0; i < in_step.velocities.size(); ++i)
    body.soft().set_velocity(i, in_step.velocities[i] - fall);
  for (std::size_t i = 0; i < in_step.pushes.size(); ++i)
    if (!in_step.pushes[i].isZero(0)) body.move_particle(i, step * in_step.pushes[i]);
}

/// The index of a rigid body among those of the step.
std::uint32_t Box2dAttachments::number_of(b2Body& rigid, float step) {
  const auto known = std::ranges::find(rigid_bodies_, &rigid);
  if (known != rigid_bodies_.end()) return static_cast<std::uint32_t>(known - rigid_bodies_.begin());
  AttachedRigid2d& added = rigids_.emplace_back();
  added.centre = to_eigen(rigid.GetWorldCenter());
  if (rigid.IsEnabled()) {  // otherwise it stands still
    added.velocity = to_eigen(rigid.GetLinearVelocity());
    added.spin = rigid.GetAngularVelocity();
  }
  if (is_simulated(rigid)) {
    const VelocityGain gain = velocity_gain(rigid, world_.GetGravity(), step);
    added.velocity += to_eigen(gain.linear);
    added.spin += gain.angular;
    added.inverse_mass = inverse_mass_of(rigid);
    added.inverse_inertia = inverse_inertia_of(rigid);
  }
  rigid_bodies_.push_back(&rigid);
  return static_cast<std::uint32_t>(rigids_.size() - 1);
}

/// Takes what the step's forces add out of velocities, as Box2D adds it after this.
void Box2dAttachments::move_rigids(float step) const {
  for (std::size_t i = 0; i < rigids_.size(); ++i) {
    b2Body& rigid = *rigid_bodies_[i];
    if (!is_simulated(rigid)) continue;
    const VelocityGain gain = velocity_gain(rigid, world_.GetGravity(), step);
    rigid.SetLinearVelocity(to_box2d(rigids_[i].velocity) - gain.linear);
    rigid.SetAngularVelocity(rigids_[i].spin - gain.angular);
  }
}

std::span<const AttachmentInStep<2>> Box2dAttachments::begin(
    std::span<const std::unique_ptr<Box2dBody>> bodies, const std::function<RigidInStep(b2Body&)>& in_step_of,
    float step) {
  end_gone();
  wake_disturbed();
  to_solve_.clear();
  for (const auto& link : links_) {
    link->hold.begin(step);
    AttachmentInStep<2>& in_step = to_solve_.emplace_back();
    in_step.rows = &link->rows;
    in_step.a = index_of(link->a, bodies);
    in_step.frame = link->hold.frame;
    in_step.touch = link->touch;
    if (link->b != nullptr) {
      in_step.b = index_of(link->b, bodies);
    } else if (link->rigid != nullptr) {
      const RigidInStep rigid = in_step_of(*link->rigid);
      in_step.rigid = rigid.number;
      in_step.frame = frame_of(rigid.pose);
    }
  }
  return to_solve_;
}

void Box2dAttachments::end() {
  for (const auto& link : links_) link->hold.end();
  links_.end_broken([&](const Link& link) { release(link); });
}

void Box2dAttachments::solve(std::span<const std::unique_ptr<Box2dBody>> bodies, float step) {
  rigids_.clear();
  rigid_bodies_.clear();
  attachments_.clear();
  for (const AttachmentInStep<2>& in_step : begin(
           bodies,
           [&](b2Body& rigid) {
             return RigidInStep{number_of(rigid, step), rigid.GetTransform()};
           },
           step))
    attachments_.add(in_step);
  if (attachments_.empty()) return;
  in_step_.resize(bodies.size());
  bodies_.assign(bodies.size(), {});
  std::vector<bool> held(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    held[i] = holds(*bodies[i]);
    if (!held[i]) continue;
    lay_out(*bodies[i], in_step_[i], step);
    const SoftBody<2>& soft = bodies[i]->soft();
    bodies_[i] = {soft.positions(),           in_step_[i].velocities,         in_step_[i].pushes,
                  in_step_[i].inverse_masses, soft.model().lattice().spacing, soft.asleep()};
  }
  attachments_.begin(bodies_, rigids_, step);
  attachments_.iterate(kIterations);
  attachments_.finish();
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (held[i]) finish(*bodies[i], in_step_[i], step);
  move_rigids(step);
  end();
}

}  // namespace softcell::ppu
