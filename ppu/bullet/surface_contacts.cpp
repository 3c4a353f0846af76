#include "ppu/bullet/surface_contacts.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

namespace softcell::ppu {
namespace {

bool is_awake(const btCollisionObject& object) {
  return !object.isStaticOrKinematicObject() && object.isActive();
}

/// Kinematic bodies, too.
bool moves(const btCollisionObject& object) {
  constexpr float kMoves = 0.05f;  // m/s and rad/s
  const btRigidBody* const body = btRigidBody::upcast(&object);
  return body && !body->isStaticObject() && body->isActive() &&
         (body->getLinearVelocity().length2() > kMoves * kMoves ||
          body->getAngularVelocity().length2() > kMoves * kMoves);
}

}  // namespace

const ContactModel& SurfaceContacts::contact_model(const std::shared_ptr<const SoftBodyModel<3>>& model) {
  std::unique_ptr<ContactModel>& known = models_[model.get()];
  if (!known) known = std::make_unique<ContactModel>(model);
  return *known;
}

template <typename Is>
bool SurfaceContacts::any_near(const BodyInStage& body, const Is& is) const {
  return std::any_of(body.obstacles.begin(), body.obstacles.end(), [&](std::uint32_t obstacle) {
    return is(*obstacles_.objects()[obstacles_.obstacles()[obstacle].rigid]);
  });
}

void SurfaceContacts::step(std::span<SurfaceBody* const> bodies, float step) {
  obstacles_.begin(world_, step);
  in_stage_.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    BodyInStage& in_stage = in_stage_[i];
    in_stage = {&bodies[i]->soft(), &bodies[i]->contact(), box_of_step(bodies[i]->soft(), step),
                std::move(in_stage.obstacles)};
    in_stage.obstacles.clear();
    obstacles_.add_near(in_stage.box, bodies[i]->filter().group, bodies[i]->filter().mask,
                        in_stage.obstacles);
    if (bodies[i]->soft().asleep() && any_near(in_stage, moves)) bodies[i]->rouse();
    in_stage.asleep = bodies[i]->soft().asleep();
    in_stage.moves = bodies[i]->moves();
    in_stage.filter = bodies[i]->filter();
    if (in_stage.asleep) in_stage.obstacles.clear();
  }
  stage_.step(in_stage_, obstacles_.obstacles(), obstacles_.rigids(), step);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (stage_.was_woken(i)) bodies[i]->rouse();
    bodies[i]->set_holds_a_moving_body(any_near(in_stage_[i], is_awake));
  }
  if (watches_) note_touches(bodies);
  obstacles_.apply();
}

void SurfaceContacts::note_touches(std::span<SurfaceBody* const> bodies) {
  pressing_.clear();
  stage_.append_contacts(pressing_);
  for (const PressingContact& contact : pressing_) {
    const SurfaceBody& a = *bodies[contact.a];
    const btCollisionObject* const object =
        contact.with_rigid ? obstacles_.objects()[contact.rigid] : nullptr;
    const SurfaceBody* const b = contact.with_rigid ? nullptr : bodies[contact.b];
    const int other =
        object != nullptr ? object->getBroadphaseHandle()->m_uniqueId : static_cast<int>(b->number());
    Touch& touch = touches_[{a.number(), contact.with_rigid, other}];
    touch.event.body = &a.soft();
    touch.event.other = b != nullptr ? &b->soft() : nullptr;
    touch.event.object = object;
    if (!touch.presses) touch.event.impulse = 0, touch.event.position.setZero(), touch.event.normal.setZero();
    touch.presses = true;
    // Sums, which take_events() divides.
    touch.event.impulse += contact.impulse;
    touch.event.position += contact.impulse * contact.point;
    touch.event.normal += contact.impulse * contact.normal;
  }
}

void SurfaceContacts::append_contacts(std::vector<Contact>& contacts) const {
  std::vector<PressingContact> pressing;
  stage_.append_contacts(pressing);
  for (const PressingContact& contact : pressing) contacts.push_back({contact.point, contact.normal});
}

void SurfaceContacts::watch(bool events) {
  watches_ = events;
  if (!events) touches_.clear();
}

void SurfaceContacts::forget(const SoftBody<3>& body) {
  for (auto& [key, touch] : touches_)
    if (touch.event.body == &body || touch.event.other == &body) touch.is_over = true;
}

std::vector<ContactEvent> SurfaceContacts::take_events() {
  // Contacts of those that sleep are not looked for, and go on.
  const auto sleeps = [](const Touch& touch) {
    return touch.event.body->asleep() && (touch.event.other == nullptr || touch.event.other->asleep());
  };
  std::vector<ContactEvent> events;
  for (auto entry = touches_.begin(); entry != touches_.end();) {
    Touch& touch = entry->second;
    if (!touch.is_over && !touch.presses && sleeps(touch)) {
      ++entry;
      continue;
    }
    ContactEvent& event = events.emplace_back(touch.event);
    if (touch.is_over || !touch.presses) {
      event.kind = ContactEvent::Kind::kEnd;
      event.impulse = 0;
      entry = touches_.erase(entry);
      continue;
    }
    event.kind = touch.is_old ? ContactEvent::Kind::kPersist : ContactEvent::Kind::kBegin;
    event.position /= event.impulse;
    event.normal = event.normal.norm() > 0 ? event.normal.normalized() : Eigen::Vector3f::UnitY();
    // Where it ends is where it pressed last.
    touch.event.position = event.position;
    touch.event.normal = event.normal;
    touch.is_old = true;
    touch.presses = false;
    ++entry;
  }
  return events;
}

}  // namespace softcell::ppu
