#include "ppu/bullet/surface_contacts.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <optional>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/may_move.h"
#include "ppu/contacts/overlap.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

bool is_awake(const btCollisionObject& object) {
  return !object.isStaticOrKinematicObject() && object.isActive();
}

bool moves(const btCollisionObject& object) {
  constexpr float kMoves = 0.05f;  // m/s and rad/s
  const btRigidBody* const body = btRigidBody::upcast(&object);
  return body && body->isActive() &&
         (velocity_of(*body).length2() > kMoves * kMoves || spin_of(*body).length2() > kMoves * kMoves);
}

}  // namespace

const std::shared_ptr<const ContactModel>& SurfaceContacts::contact_model(
    const std::shared_ptr<const SoftBodyModel<3>>& model) {
  std::shared_ptr<const ContactModel>& known = models_[model.get()];
  if (known) return known;
  // Without a mesh the surface is the lattice's own boundary, which is quickly measured.
  known = model->is_piece() && !model->mesh().triangles.empty()
              ? std::make_shared<ContactModel>(model, *contact_model(model->whole()))
              : std::make_shared<ContactModel>(model);
  return known;
}

void SurfaceContacts::adopt(std::unique_ptr<ContactModel> contact) { models_.adopt(std::move(contact)); }

template <typename Is>
bool SurfaceContacts::any_near(const BodyInSubstep& body, const Is& is) const {
  return std::any_of(body.obstacles.begin(), body.obstacles.end(), [&](std::uint32_t obstacle) {
    return is(*obstacles_.objects()[obstacles_.obstacles()[obstacle].rigid]);
  });
}

/// Wakes a sleeper if something that moves has come near, or something that it has seen is gone, has moved or has changed.
void SurfaceContacts::wake_if_disturbed(std::span<SurfaceBody* const> bodies, std::size_t body) {
  SurfaceBody& sleeper = *bodies[body];
  const auto moves_or_is_seen = [&](const btCollisionObject& object) {
    sleeper.see(object.getWorldArrayIndex());
    return moves(object);
  };
  if (any_near(in_substep_[body], moves_or_is_seen)) {
    sleeper.rouse();
  } else if (sleeper.notices_a_change()) {
    sleeper.rouse();
    shaken_.push_back(body);
  }
}

/// Wakes sleepers that lie on bodies whose support has changed, directly or through others. A lift may be so slow that the bodies on it do
/// not move fast enough to wake each other.
void SurfaceContacts::wake_those_on_shaken(std::span<SurfaceBody* const> bodies) {
  for (std::size_t i = 0; i < shaken_.size(); ++i) {
    const SurfaceBody& shaken = *bodies[shaken_[i]];
    const Bounds<3> box = shaken.soft().bounds();
    for (std::size_t other = 0; other < bodies.size(); ++other) {
      if (!bodies[other]->soft().asleep()) continue;
      bodies[other]->lose(shaken, box);
      if (!bodies[other]->soft().asleep()) shaken_.push_back(other);
    }
  }
  shaken_.clear();
}

/// For a body that has just fallen asleep. The program's callbacks may have removed some of these objects in this substep.
void SurfaceContacts::see_what_is_near(SurfaceBody& sleeper, const BodyInSubstep& in_substep) const {
  for (const std::uint32_t obstacle : in_substep.obstacles) {
    const btCollisionObject* const object = obstacles_.objects()[obstacles_.obstacles()[obstacle].rigid];
    const int place = SeenObject::place_of(world_, object);
    if (place >= 0) sleeper.see(place);
  }
}

void SurfaceContacts::step(std::span<SurfaceBody* const> bodies, float step) {
  models_.forget_unused();
  obstacles_.begin(world_, step);
  if (!attachments_.empty()) attachments_.begin();
  in_substep_.resize(bodies.size());
  softs_.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    BodyInSubstep& in_substep = in_substep_[i];
    const SoftBody<3>& soft = bodies[i]->soft();
    softs_.push_back(&soft);
    in_substep = {.model = &bodies[i]->contact(),
                  .positions = soft.positions(),
                  .velocities = soft.velocities(),
                  .friction = soft.settings().friction,
                  .restitution = soft.settings().restitution,
                  .box = box_of_step(soft.positions(), soft.velocities(), step),
                  .obstacles = std::move(in_substep.obstacles),
                  .sides = &bodies[i]->sides(),
                  .self_contacts = soft.settings().self_contacts};
    in_substep.obstacles.clear();
    obstacles_.add_near(in_substep.box, bodies[i]->filter().group, bodies[i]->filter().mask,
                        in_substep.obstacles);
    if (!attachments_.empty()) attachments_.part(*bodies[i], obstacles_, in_substep.obstacles);
    if (bodies[i]->soft().asleep()) wake_if_disturbed(bodies, i);
    in_substep.filter = bodies[i]->filter();
  }
  wake_those_on_shaken(bodies);
  wake_those_in_the_way(bodies);
  solver_.settings.bounces = {world_.getSolverInfo().m_restitutionVelocityThreshold,
                              to_eigen(world_.getGravity())};
  in_step_.clear();
  if (!attachments_.empty()) attachments_.fill(in_step_, bodies, obstacles_, step);
  const auto is_attached = [&](const btCollisionObject& object) {
    return !attachments_.empty() && attachments_.are_to(object);
  };
  const RigidLinks links = links_.find(world_, obstacles_, is_attached, step);
  solver_.step(in_substep_, obstacles_.obstacles(), obstacles_.rigids(), links, step);
  move(bodies, step);
  solver_.find_islands(islands_);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i]->set_island(islands_.find(static_cast<std::uint32_t>(i)));
    bodies[i]->set_holds_a_moving_body(any_near(in_substep_[i], [&](const btCollisionObject& object) {
      return is_awake(object) && !attachments_.joins(*bodies[i], object);
    }));
  }
  if (!attachments_.empty()) attachments_.end();
  if (watches_) {
    touches_.begin_step();
    note_touches(bodies);
    note_triggers(bodies, step);
  }
  find_at_rest(bodies);
  obstacles_.apply(at_rest_);
}

/// Finds rigid bodies near which all soft ones are at rest. A rigid body without a soft one near it, which links may move, counts if all
/// soft ones are at rest.
void SurfaceContacts::find_at_rest(std::span<SurfaceBody* const> bodies) {
  enum : char { kAlone, kAtRest, kDisturbed };
  near_rigids_.assign(obstacles_.objects().size(), kAlone);
  bool all_at_rest = true;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool is_restless = !bodies[i]->soft().asleep() && !bodies[i]->is_still();
    all_at_rest = all_at_rest && !is_restless;
    for (const std::uint32_t obstacle : in_substep_[i].obstacles) {
      char& rigid = near_rigids_[obstacles_.obstacles()[obstacle].rigid];
      rigid = std::max(rigid, static_cast<char>(is_restless ? kDisturbed : kAtRest));
    }
  }
  at_rest_.resize(near_rigids_.size());
  for (std::size_t r = 0; r < at_rest_.size(); ++r)
    at_rest_[r] = near_rigids_[r] == kAtRest || (near_rigids_[r] == kAlone && all_at_rest);
}

void SurfaceContacts::move(std::span<SurfaceBody* const> bodies, float step) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (in_substep_[i].asleep) continue;
    SoftBody<3>& soft = bodies[i]->soft();
    const auto velocities = solver_.velocities(i), pushes = solver_.pushes(i);
    MeanSpeed real;
    for (std::size_t p = 0; p < velocities.size(); ++p) {
      const Eigen::Vector3f velocity = velocities[p] + pushes[p];
      soft.set_particle(p, soft.position(p) + step * velocity, velocities[p]);
      if (solver_.is_crushed(i)) real.add(soft.model().masses()[p], velocity);
    }
    bodies[i]->set_real_speed(solver_.is_crushed(i) ? std::optional(real.value()) : std::nullopt);
  }
}

/// Wakes bodies before anything is solved: a sleeping body would stop everything that hits it like a wall, and absorb its momentum.
void SurfaceContacts::wake_those_in_the_way(std::span<SurfaceBody* const> bodies) {
  const auto sleeps = [&](const SurfaceBody* body) { return body->soft().asleep(); };
  moving_.clear();
  if (std::any_of(bodies.begin(), bodies.end(), sleeps)) {
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
      if (!sleeps(bodies[i]) && bodies[i]->moves()) moving_.push_back(i);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    BodyInSubstep& sleeper = in_substep_[i];
    const auto is_in_the_way_of = [&](std::uint32_t other) {
      return overlap(sleeper.box, in_substep_[other].box) &&
             sleeper.filter.may_touch(in_substep_[other].filter);
    };
    if (sleeps(bodies[i]) && std::any_of(moving_.begin(), moving_.end(), is_in_the_way_of))
      bodies[i]->rouse();
    sleeper.asleep = sleeps(bodies[i]);
    if (sleeper.asleep) sleeper.obstacles.clear();
  }
}

/// A body that was added after the last substep has no island yet and stays awake. Attached bodies fall asleep in attachments_.let_sleep();
/// here they only keep their island awake if they are restless.
void SurfaceContacts::let_sleep(std::span<SurfaceBody* const> bodies, const SleepSettings& sleep) {
  is_restless_.assign(islands_.numbers(), false);
  for (const SurfaceBody* const body : bodies)
    if (body->island() && !body->soft().asleep() && !body->may_fall_asleep(sleep))
      is_restless_[*body->island()] = true;
  for (SurfaceBody* const body : bodies)
    if (body->island() && !body->soft().asleep() && !body->is_attached() && !is_restless_[*body->island()])
      body->fall_asleep_with_others();
  attachments_.let_sleep(sleep);
  // New sleepers see what is near before the program can change it. Bodies that were added in this substep come last and are awake.
  for (std::size_t i = 0; i < std::min(bodies.size(), in_substep_.size()); ++i)
    if (bodies[i]->soft().asleep() && !in_substep_[i].asleep) see_what_is_near(*bodies[i], in_substep_[i]);
}

SurfaceContacts::Touch& SurfaceContacts::touch_of(const SurfaceBody& body, TouchedKind kind,
                                                  const btCollisionObject& object) {
  const int number = object.getBroadphaseHandle()->m_uniqueId;
  SC_ASSERT(number >= 0, "an object of Bullet has the number {}", number);
  Touch& touch = touches_[{body.number(), kind, static_cast<std::uint64_t>(number)}];
  touch.event.body = &body.soft();
  touch.event.object = &object;
  return touch;
}

void SurfaceContacts::note_touches(std::span<SurfaceBody* const> bodies) {
  pressing_.clear();
  solver_.append_contacts(pressing_);
  for (const PressingContact& contact : pressing_) {
    const SurfaceBody &body = *bodies[contact.a], &other = *bodies[contact.b];
    Touch& touch = contact.with_rigid
                       ? touch_of(body, TouchedKind::kRigid, *obstacles_.objects()[contact.rigid])
                       : touches_[{body.number(), TouchedKind::kSoft, other.number()}];
    touch.event.body = &body.soft();
    if (!contact.with_rigid) touch.event.other = &other.soft();
    touch.add(contact.impulse, contact.impulse, contact.point, contact.normal);
  }
}

/// Uses bodies' places after the substep, also those of sleeping bodies.
void SurfaceContacts::note_triggers(std::span<SurfaceBody* const> bodies, float step) {
  triggers_.begin(world_, step);
  for (SurfaceBody* const body : bodies) {
    const SoftBody<3>& soft = body->soft();
    near_.clear();
    triggers_.add_near(soft.bounds(), body->filter().group, body->filter().mask, near_);
    if (near_.empty()) continue;
    cells_.place(soft.model().lattice(), soft.positions());
    for (const std::uint32_t trigger : near_) {
      const Obstacle& volume = triggers_.obstacles()[trigger];
      if (const auto overlap = find_overlap(soft.positions(), body->contact(), cells_, volume))
        touch_of(*body, TouchedKind::kTrigger, *triggers_.objects()[volume.rigid])
            .add(0, 1, overlap->point, overlap->normal);
    }
  }
}

void SurfaceContacts::append_contacts(std::vector<Contact>& contacts) const {
  std::vector<PressingContact> pressing;
  solver_.append_contacts(pressing);
  for (const PressingContact& contact : pressing) {
    Contact& appended = contacts.emplace_back();
    appended.position = contact.point;
    appended.normal = contact.normal;
    appended.impulse = contact.impulse;
    appended.first.soft = softs_[contact.a];
    if (contact.with_rigid)
      appended.second.object = obstacles_.objects()[contact.rigid];
    else
      appended.second.soft = softs_[contact.b];
  }
}

void SurfaceContacts::watch(bool events) {
  watches_ = events;
  if (!events) touches_.clear();
}

void SurfaceContacts::forget(const SoftBody<3>& body) {
  touches_.forget(body);
  solver_.forget_who_presses();
}

}  // namespace softcell::ppu
