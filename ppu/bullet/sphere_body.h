#pragma once
// A soft body that touches with a rigid sphere at each of its outer particles, as in the report of 2008.

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/contact_sphere.h"
#include "ppu/bullet/coupled_body.h"
#include "softcell/base/assert.h"
#include "softcell/bullet/bullet_soft_bodies.h"

namespace softcell::ppu {

/// One soft body and the rigid bodies of its outer particles, in the order of SoftBodyModel::outer().
class SphereBody final : public CoupledBody {
 public:
  SphereBody(btDiscreteDynamicsWorld& world, SoftBody<3> soft) : CoupledBody(world, std::move(soft)) {
    add_particles();
  }

  ~SphereBody() override { remove_particles(); }

  void begin_substep() override {
    if (was_changed()) {
      if (soft_.shared_model() != model_) {  // the program has assigned a body of another model
        remove_particles();
        add_particles();
      }
      rouse();
      place_particles();
      for (btRigidBody& particle : particles_) {
        particle.setFriction(soft_.settings().friction);
        particle.setRestitution(soft_.settings().restitution);
      }
    } else if (!soft_.asleep()) {
      gather();
    }
  }

  /// Bullet takes a filter only when a body is added.
  void set_filter(const CollisionFilter& filter) override {
    CoupledBody::set_filter(filter);
    for (btRigidBody& particle : particles_) {
      world_.removeRigidBody(&particle);
      world_.addRigidBody(&particle, filter.group, filter.mask);
    }
  }

  /// A body with spheres does not break.
  bool can_break() const override { return false; }
  Bounds<3> box() const override {
    SC_ASSERT(!particles_.empty(), "a body without contacts has no box in Bullet");
    Bounds<3> box{to_eigen(particles_[0].getWorldTransform().getOrigin()), {}};
    box.high = box.low;
    for (const btRigidBody& particle : particles_) {
      box.low = box.low.cwiseMin(to_eigen(particle.getWorldTransform().getOrigin()));
      box.high = box.high.cwiseMax(to_eigen(particle.getWorldTransform().getOrigin()));
    }
    return box;
  }

  float reach() const override { return soft_.model().soft_contact_radius(); }

  bool can_be_touched() const override { return true; }

  /// Whether particles in Bullet differ from what was gathered last.
  bool was_pushed() const override {
    if (soft_.asleep()) return false;
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      fetch_ahead(i);
      const btRigidBody& particle = particles_[i];
      if (to_eigen(particle.getLinearVelocity()) != soft_.velocities()[outer[i]] ||
          to_eigen(particle.getWorldTransform().getOrigin()) != soft_.position(outer[i]))
        return true;
    }
    return false;
  }

  /// Sets the new velocities, with which Bullet integrates.
  void apply(float step) override {
    if (soft_.asleep()) return;
    SC_ASSERT(step > 0, "a substep of {} s", step);
    soft_.limit_speed(BulletSoftBodies::kMaxTravelInCells * soft_.model().lattice().spacing / step);
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      fetch_ahead(i);
      particles_[i].setLinearVelocity(to_bullet(soft_.velocities()[outer[i]]));
    }
  }

  /// Takes over outer particles from Bullet; inner ones follow them.
  void end_substep(float step, const std::optional<SleepSettings>& sleep) override {
    if (soft_.asleep()) {
      if (sleep && !falls_another_way() && !was_touched()) return;
      if (falls_another_way()) stillness_.begin();
      wake();
    }
    gather();
    soft_.advance_inner(step, to_eigen(world_.getGravity()));
    if (sleep) fall_asleep_when_still(step, *sleep);
  }

 private:
  void add_particles() {
    model_ = soft_.shared_model();
    shape_.emplace(model_->contact_radius(), model_->soft_contact_radius(),
                   BulletSoftBodies::kMaxTravelInCells * model_->lattice().spacing);
    particles_.reserve(model_->outer().size());
    for (const std::uint32_t particle : model_->outer()) add_particle(particle);
    SC_ASSERT(particles_.size() == model_->outer().size(), "{} rigid bodies for {} particles",
              particles_.size(), model_->outer().size());
  }
  void remove_particles() {
    for (btRigidBody& particle : particles_) world_.removeRigidBody(&particle);
    particles_.clear();
  }

  /// Whether Bullet has woken a particle, because something that moves touches it.
  bool was_touched() const {
    return std::any_of(particles_.begin(), particles_.end(), [](const btRigidBody& particle) {
      return particle.getActivationState() != ISLAND_SLEEPING;
    });
  }

  void wake() override {
    CoupledBody::wake();
    for (btRigidBody& particle : particles_) {
      particle.forceActivationState(DISABLE_DEACTIVATION);
      particle.setGravity(world_.getGravity());  // Bullet sets it only for bodies that are awake
    }
  }

  void fall_asleep() override {
    for (btRigidBody& particle : particles_) {
      particle.setLinearVelocity(btVector3(0, 0, 0));
      particle.forceActivationState(ISLAND_SLEEPING);
    }
  }

  void add_particle(std::uint32_t number) {
    // No inertia: spheres that turned would roll, and a body on rolling particles has no friction.
    btRigidBody::btRigidBodyConstructionInfo info(soft_.model().masses()[number], nullptr, &*shape_,
                                                  btVector3(0, 0, 0));
    info.m_startWorldTransform.setOrigin(to_bullet(soft_.position(number)));
    info.m_friction = soft_.settings().friction;
    info.m_restitution = soft_.settings().restitution;
    info.m_linearDamping = 0;
    info.m_angularDamping = 0;
    SC_ASSERT(particles_.size() < particles_.capacity(),
              "particle {} would move the {} before it, whose addresses Bullet keeps", number,
              particles_.size());
    btRigidBody& particle = particles_.emplace_back(info);
    particle.setAngularFactor(0);
    particle.setFlags(0);  // no gyroscopic term, as it does not turn
    // A single particle never sleeps: its neighbours would be pulled towards one that hangs still.
    particle.setActivationState(DISABLE_DEACTIVATION);
    particle.setUserPointer(&soft_);
    particle.setUserIndex(static_cast<int>(number));
    world_.addRigidBody(&particle, filter().group, filter().mask);
  }

  /// A btRigidBody takes 744 bytes, with position and velocity far apart: a loop over thousands of them would wait for memory twice for
  /// each.
  void fetch_ahead(std::size_t i) const {
    constexpr std::size_t kAhead = 8;
    if (i + kAhead >= particles_.size()) return;
    const btRigidBody& later = particles_[i + kAhead];
    __builtin_prefetch(&later.getWorldTransform().getOrigin());
    __builtin_prefetch(&later.getLinearVelocity());
  }

  void gather() {
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      fetch_ahead(i);
      const btRigidBody& particle = particles_[i];
      soft_.set_particle(outer[i], to_eigen(particle.getWorldTransform().getOrigin()),
                         to_eigen(particle.getLinearVelocity()));
    }
  }

  /// The user has changed the body: moves its particles in Bullet, and removes contacts of those that are elsewhere now.
  void place_particles() {
    see_changes();
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      btRigidBody& particle = particles_[i];
      particle.setLinearVelocity(to_bullet(soft_.velocities()[outer[i]]));
      if (to_eigen(particle.getWorldTransform().getOrigin()) == soft_.position(outer[i])) continue;
      particle.getWorldTransform().setOrigin(to_bullet(soft_.position(outer[i])));
      particle.setInterpolationWorldTransform(particle.getWorldTransform());
      world_.getPairCache()->cleanProxyFromPairs(particle.getBroadphaseProxy(), world_.getDispatcher());
    }
  }

  std::shared_ptr<const SoftBodyModel<3>> model_;  // whose particles these are
  std::optional<ContactSphere> shape_;
  std::vector<btRigidBody> particles_;  // must never reallocate: Bullet keeps their addresses
};

}  // namespace softcell::ppu
