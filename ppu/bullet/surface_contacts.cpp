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
    in_stage.touches = bodies[i]->can_be_touched();
    if (in_stage.touches) {
      obstacles_.add_near(in_stage.box, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter,
                          in_stage.obstacles);
    }
    if (bodies[i]->soft().asleep() && any_near(in_stage, moves)) bodies[i]->rouse();
    in_stage.asleep = bodies[i]->soft().asleep();
    in_stage.moves = bodies[i]->moves();
    if (in_stage.asleep) in_stage.obstacles.clear();
  }
  stage_.step(in_stage_, obstacles_.obstacles(), obstacles_.rigids(), step);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (stage_.was_woken(i)) bodies[i]->rouse();
    bodies[i]->set_holds_a_moving_body(any_near(in_stage_[i], is_awake));
  }
  obstacles_.apply();
}

}  // namespace softcell::ppu
