#include "ppu/box2d/surface_contacts_2d.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "ppu/contacts/overlap.h"
#include "ppu/contacts/piece_sides.h"
#include "ppu/numbers/box_around.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// Handing work to SPEs ten times in a step takes longer than the contacts of so few particles. Once SPEs are used, they are used in every
/// step: they need the motion from the step before.
constexpr std::size_t kFewParticles = 1000;

/// Also for kinematic bodies.
bool moves(const b2Body& body) {
  constexpr float kMoves = 0.05f;  // m/s and rad/s
  return body.GetType() != b2_staticBody && body.IsAwake() &&
         (body.GetLinearVelocity().LengthSquared() > kMoves * kMoves ||
          std::abs(body.GetAngularVelocity()) > kMoves);
}

float largest_cell(SurfaceContacts2d::Bodies bodies) {
  float largest = 0;
  for (const auto& body : bodies) largest = std::max(largest, body->soft().model().lattice().spacing);
  return largest;
}

}  // namespace

SurfaceContacts2d::SurfaceContacts2d(b2World& world, std::shared_ptr<ContactWorker> worker)
    : world_(world), worker_(std::move(worker)) {
  solver_.attachments = &attachments_;
}

/// A piece is drawn as its part of the whole, and touches as it is drawn.
std::unique_ptr<SurfaceContacts2d::Model> SurfaceContacts2d::make_piece(
    const std::shared_ptr<const SoftBodyModel<2>>& piece, const Model& whole) {
  return std::make_unique<Model>(piece, skin_of_piece(whole.skin, whole.shared->lattice(), piece->lattice()));
}

void SurfaceContacts2d::adopt(std::unique_ptr<Model> piece) { models_.adopt(std::move(piece)); }

const std::shared_ptr<const SurfaceContacts2d::Model>& SurfaceContacts2d::model_of(
    const std::shared_ptr<const SoftBodyModel<2>>& model) {
  // Keeps its address, even when others are added.
  std::shared_ptr<const Model>& known = models_[model.get()];
  if (known) return known;
  if (model->is_piece())
    known = make_piece(model, *whole_of(model));
  else
    known = std::make_shared<Model>(model, touching_skin(*model));
  return known;
}

void SurfaceContacts2d::draw(const std::shared_ptr<const SoftBodyModel<2>>& model, const Skin2d& skin) {
  std::shared_ptr<const Model>& known = models_[model.get()];
  if (!known) known = std::make_shared<Model>(model, skin);
}

void SurfaceContacts2d::lift(const Box2dBody& body, Kept& kept, float step) {
  const SoftBody<2>& soft = body.soft();
  kept.model->layer.lift(soft.positions(), 0.5f * soft.model().lattice().spacing, kept.positions);
  kept.model->layer.lift(soft.velocities(), 0, kept.velocities);
  if (soft.asleep()) return;
  const Vector2f fall = step * to_eigen(world_.GetGravity());
  for (Vector3f& v : kept.velocities) v.head<2>() += fall;
}

void SurfaceContacts2d::begin_attachments(Bodies bodies, Box2dAttachments& attachments, float step) {
  const auto in_step_of = [&](b2Body& rigid) {
    return Box2dAttachments::RigidInStep{obstacles_.rigid_of(rigid), obstacles_.pose_of(rigid)};
  };
  attachments_.clear();
  attached_rigids_.clear();
  for (const AttachmentInStep<2>& attachment : attachments.begin(bodies, in_step_of, step)) {
    attachments_.add(attachment);
    if (attachment.rigid != AttachmentInStep<2>::kNone) attached_rigids_.push_back(attachment.rigid);
  }
}

void SurfaceContacts2d::begin(Bodies bodies, const Box2dAttachments& attachments, float step) {
  in_substep_.resize(bodies.size());
  softs_.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Box2dBody& body = *bodies[i];
    const SoftBody<2>& soft = body.soft();
    Kept& kept = kept_[&body];
    if (kept.number == kNoNumber) kept.number = next_number_++;
    if (soft.position(0) != kept.place_of_sides) kept.sides = {};  // the program has moved the body
    kept.model = model_of(soft.shared_model());
    lift(body, kept, step);
    softs_.push_back(&soft);
    BodyInSubstep& in_substep = in_substep_[i];
    in_substep = {.model = &kept.model->contact,
                  .positions = kept.positions,
                  .velocities = kept.velocities,
                  .friction = std::sqrt(soft.settings().friction),
                  .restitution = soft.settings().restitution,
                  .box = box_of_step(kept.positions, kept.velocities, step),
                  .obstacles = std::move(in_substep.obstacles),
                  .sides = &kept.sides,
                  .self_contacts = soft.settings().self_contacts};
    in_substep.obstacles.clear();
    in_substep.filter = body.filter();
    obstacles_.add_near(in_substep.box, soft.centre_of_mass(), in_substep.filter, in_substep.obstacles);
    std::erase_if(in_substep.obstacles, [&](std::uint32_t obstacle) {
      return attachments.parts(body, *obstacles_.bodies()[obstacles_.obstacles()[obstacle].rigid]);
    });
    if (!soft.asleep()) kept.seen.clear();
    if (soft.asleep()) wake_if_disturbed(kept, body, in_substep);
    if (!soft.asleep() && kept.lies()) rise(kept);
  }
}

/// Whether the world no longer has the body, or the body looks different to what touches it. Box2D has no callback for that.
bool SurfaceContacts2d::is_gone(const Support& support) {
  return !obstacles_.has(support.body) || obstacles_.look(*support.body) != support.look;
}

/// Remembers a body near a sleeper as it is when the sleeper first sees it.
void SurfaceContacts2d::see(Kept& kept, b2Body& body) {
  if (std::ranges::find(kept.seen, &body, &Support::body) == kept.seen.end())
    kept.seen.push_back(as_it_is(body));
}

/// Wakes a sleeper if a body beside it has begun to move, or if what it lies on is gone or has moved. In the second case it also wakes the
/// bodies that lie on the sleeper, because a slow support, such as a lift, does not move the sleeper fast enough to wake them.
void SurfaceContacts2d::wake_if_disturbed(Kept& kept, Box2dBody& body, const BodyInSubstep& in_substep) {
  const auto moves_there = [&](std::uint32_t obstacle) {
    b2Body& beside = *obstacles_.bodies()[obstacles_.obstacles()[obstacle].rigid];
    see(kept, beside);
    return moves(beside);
  };
  if (std::ranges::any_of(in_substep.obstacles, moves_there)) {
    body.wake();
  } else if (has_lost_support(kept, body.soft())) {
    body.wake();
    tell_those_on(body);
  }
}

bool SurfaceContacts2d::has_lost_support(const Kept& kept, const SoftBody<2>& sleeper) {
  constexpr float kCreep = 0.02f;  // cells: more than the depth that contacts allow
  const float far = kCreep * sleeper.model().lattice().spacing;
  const Eigen::Vector2f centre = sleeper.centre_of_mass();
  const auto is_gone_or_moved = [&](const Support& support) {
    return is_gone(support) || !is_same(support.body->GetTransform(), support.pose);
  };
  const auto is_gone_or_elsewhere = [&](const Support& seen) {
    if (is_gone(seen)) return true;
    const b2Vec2 middle{centre.x(), centre.y()};
    const b2Vec2 there = b2Mul(seen.body->GetTransform(), b2MulT(seen.pose, middle));
    return b2DistanceSquared(there, middle) > far * far;
  };
  return kept.lost_support || std::ranges::any_of(kept.supports, is_gone_or_moved) ||
         std::ranges::any_of(kept.seen, is_gone_or_elsewhere);
}

/// Wakes what has slept together with this body, which is awake now.
void SurfaceContacts2d::rise(Kept& kept) {
  for (const Support& support : kept.supports)
    if (has_body(world_, support.body) && support.body->GetType() == b2_dynamicBody)
      support.body->SetAwake(true);
  kept.supports.clear();
  kept.lies_on.clear();
  kept.lost_support = false;
}

/// Wakes bodies before anything is solved: a sleeping body would stop everything that hits it like a wall, and absorb its momentum.
void SurfaceContacts2d::wake_those_in_the_way(Bodies bodies) {
  moving_.clear();
  for (std::uint32_t i = 0; i < bodies.size(); ++i)
    if (!bodies[i]->soft().asleep() && bodies[i]->moves()) moving_.push_back(i);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    BodyInSubstep& sleeper = in_substep_[i];
    const auto hits = [&](std::uint32_t other) {
      return overlap(sleeper.box, in_substep_[other].box) &&
             sleeper.filter.may_touch(in_substep_[other].filter);
    };
    if (bodies[i]->soft().asleep() && std::ranges::any_of(moving_, hits)) {
      bodies[i]->wake();
      rise(kept_.at(bodies[i].get()));
    }
    sleeper.asleep = bodies[i]->soft().asleep();
    if (sleeper.asleep) sleeper.obstacles.clear();
  }
}

void SurfaceContacts2d::step(Bodies bodies, Box2dAttachments& attachments, float step) {
  if (bodies.empty()) {
    models_.forget_unused();
    return obstacles_.forget_places();
  }
  SC_ASSERT(step > 0 && !world_.IsLocked(), "contacts of {} s within a step of Box2D, or of none", step);
  obstacles_.begin(world_, step, largest_cell(bodies));
  begin_attachments(bodies, attachments, step);
  begin(bodies, attachments, step);
  models_.forget_unused();  // now each body holds what it uses
  wake_those_in_the_way(bodies);
  solver_.settings.bounces = {
      .least_speed = 1,  // Box2D's threshold for restitution
      .gravity = {world_.GetGravity().x, world_.GetGravity().y, 0},
      .mix = BounceSettings::Mix::kLarger,
  };
  std::size_t particles = 0;
  for (const auto& body : bodies) particles += body->soft().positions().size();
  if (particles >= kFewParticles) solver_.worker = worker_.get();
  const RigidLinks links = links_.find(obstacles_, attached_rigids_, step);
  solver_.step(in_substep_, obstacles_.obstacles(), obstacles_.rigids(), links, step);
  move(bodies, step);
  obstacles_.apply();
  attachments.end();
  note_touches(bodies);
  if (!watches_) return;
  log_.begin_step();
  log_touches(bodies);
  log_sensors(bodies, step);
}

void SurfaceContacts2d::move(Bodies bodies, float step) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (in_substep_[i].asleep) continue;
    SoftBody<2>& soft = bodies[i]->soft();
    MeanSpeed real;
    for (std::size_t p = 0; p < soft.positions().size(); ++p) {
      const Vector2f velocity = FlatLayer::lower(solver_.velocities(i), p);
      const Vector2f moved = velocity + FlatLayer::lower(solver_.pushes(i), p);
      soft.set_particle(p, soft.position(p) + step * moved, velocity);
      if (solver_.is_crushed(i)) real.add(soft.model().masses()[p], moved);
    }
    bodies[i]->set_real_speed(solver_.is_crushed(i) ? std::optional(real.value()) : std::nullopt);
    kept_.at(bodies[i].get()).place_of_sides = soft.position(0);
  }
}

/// Keeps rigid bodies awake that press on a soft body which is awake.
void SurfaceContacts2d::note_touches(Bodies bodies) {
  pressing_.clear();
  solver_.append_contacts(pressing_);
  touches_.soft.clear();
  touches_.rigid.clear();
  for (const PressingContact& contact : pressing_) {
    Box2dBody* const a = bodies[contact.a].get();
    if (contact.with_rigid) {
      b2Body* const rigid = obstacles_.bodies()[contact.rigid];
      if (!touches_.rigid.empty() && touches_.rigid.back() == std::pair(a, rigid)) continue;
      touches_.rigid.emplace_back(a, rigid);
      if (rigid->GetType() == b2_dynamicBody) rigid->SetAwake(true);
    } else if (contact.a != contact.b) {
      Box2dBody* const b = bodies[contact.b].get();
      if (touches_.soft.empty() || touches_.soft.back() != std::pair(a, b)) touches_.soft.emplace_back(a, b);
    }
  }
}

void SurfaceContacts2d::forget_destroyed() {
  if (touches_.rigid.empty()) return;
  living_.clear();
  for (const b2Body* body = world_.GetBodyList(); body != nullptr; body = body->GetNext())
    living_.push_back(body);
  std::ranges::sort(living_, std::less<>());
  std::erase_if(touches_.rigid, [&](const auto& pair) {
    const bool is_gone = !std::ranges::binary_search(living_, pair.second, std::less<>());
    if (is_gone) pair.first->wake();  // its load or its support is gone
    return is_gone;
  });
}

void SurfaceContacts2d::log_touches(Bodies bodies) {
  for (const PressingContact& contact : pressing_) {
    const std::uint32_t number = kept_.at(bodies[contact.a].get()).number;
    TouchLog<ContactEvent2d>::Touch* touch;
    if (contact.with_rigid) {
      b2Body* const rigid = obstacles_.bodies()[contact.rigid];
      touch = &log_[{number, TouchedKind::kRigid, obstacles_.number(*rigid)}];
      touch->event.rigid = rigid;
    } else {
      const Box2dBody* const other = bodies[contact.b].get();
      touch = &log_[{number, TouchedKind::kSoft, kept_.at(other).number}];
      touch->event.other = &other->soft();
    }
    touch->event.body = &bodies[contact.a]->soft();
    touch->add(contact.impulse, contact.impulse, contact.point.head<2>(), contact.normal.head<2>());
  }
}

/// Uses bodies' places after the step, also those of sleeping bodies.
void SurfaceContacts2d::log_sensors(Bodies bodies, float step) {
  sensors_.begin(world_, step, largest_cell(bodies));
  for (const auto& body : bodies) {
    const SoftBody<2>& soft = body->soft();
    const Kept& kept = kept_.at(body.get());
    kept.model->layer.lift(soft.positions(), 0.5f * soft.model().lattice().spacing, moved_);
    near_.clear();
    sensors_.add_near(box_around<Bounds<3>>(moved_), soft.centre_of_mass(), body->filter(), near_);
    if (near_.empty()) continue;
    cells_.place(*kept.model->layer.lattice(), moved_);
    for (const std::uint32_t near : near_) {
      const auto overlap = find_overlap(moved_, kept.model->contact, cells_, sensors_.obstacles()[near]);
      if (!overlap) continue;
      b2Fixture& sensor = sensors_.fixture(near);
      const std::uint64_t of_body = sensors_.number(*sensor.GetBody());
      auto& touch =
          log_[{kept.number, TouchedKind::kTrigger, of_body << 32 | Box2dObstacles::number(sensor)}];
      touch.event.body = &soft;
      touch.event.rigid = sensor.GetBody();
      touch.event.sensor = &sensor;
      touch.add(0, 1, overlap->point.head<2>(), overlap->normal.head<2>());
    }
  }
}

void SurfaceContacts2d::watch(bool events) {
  watches_ = events;
  if (!events) log_.clear();
}

void SurfaceContacts2d::append_contacts(std::vector<Contact2d>& contacts) const {
  for (const PressingContact& contact : pressing_) {
    Contact2d& appended = contacts.emplace_back();
    appended.position = contact.point.head<2>();
    appended.normal = contact.normal.head<2>();
    appended.impulse = contact.impulse;
    appended.first = softs_[contact.a];
    if (contact.with_rigid)
      appended.rigid = obstacles_.bodies()[contact.rigid];
    else
      appended.second = softs_[contact.b];
  }
}

void SurfaceContacts2d::let_lie(const Box2dBody& body) {
  Kept& kept = kept_[&body];
  for (const auto& [soft, rigid] : touches_.rigid)
    if (soft == &body) kept.supports.push_back(as_it_is(*rigid));
  for (const auto& [a, b] : touches_.soft) {
    if (a == &body) kept.lies_on.push_back(b);
    if (b == &body) kept.lies_on.push_back(a);
  }
}

/// What the body touched in the last step, and what it lies on.
void SurfaceContacts2d::forget_contacts(const Box2dBody& body) {
  if (const auto known = kept_.find(&body); known != kept_.end()) rise(known->second);
  std::erase_if(touches_.soft, [&](const auto& pair) { return pair.first == &body || pair.second == &body; });
  std::erase_if(touches_.rigid, [&](const auto& pair) { return pair.first == &body; });
  tell_those_on(body);
  solver_.forget_who_presses();
}

void SurfaceContacts2d::forget(const Box2dBody& body) {
  forget_contacts(body);
  kept_.erase(&body);
  log_.forget(body.soft());
}

/// The body keeps its number: for the program it goes on, as one of its pieces, and so do its touches.
void SurfaceContacts2d::follow_pieces(const Box2dBody& body, const SoftBodyModel<2>& whole,
                                      std::span<const Piece> pieces) {
  forget_contacts(body);
  const auto there = kept_.find(&body);
  if (there == kept_.end()) return;  // no step has had it
  const Kept before = std::exchange(there->second, Kept());
  there->second.number = before.number;
  if (before.model == nullptr || before.model->shared.get() != &whole) return;
  for (const Piece& piece : pieces) {
    Kept& kept = kept_[piece.body];
    const SoftBody<2>& soft = piece.body->soft();
    kept.place_of_sides = soft.position(0);
    kept.sides = sides_of_piece(before.sides, before.model->contact, before.positions, whole.lattice(),
                                soft.model().lattice(), piece.particle_of);
  }
}

void SurfaceContacts2d::tell_those_on(const Box2dBody& body) {
  for (auto& [other, kept] : kept_)
    if (std::ranges::find(kept.lies_on, &body) != kept.lies_on.end()) kept.lost_support = true;
}

void SurfaceContacts2d::shift(const Vector2f& by) {
  obstacles_.shift(world_, by);
  for (auto& [body, kept] : kept_) {
    kept.place_of_sides = body->soft().position(0);
    for (std::vector<Support>* const known : {&kept.supports, &kept.seen})
      for (Support& support : *known) support.pose.p += to_box2d(by);
  }
}

}  // namespace softcell::ppu
