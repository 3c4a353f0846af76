#pragma once
// One soft body in a Bullet world, with any kind of contacts: spheres (sphere_body.h), its drawn surface (surface_body.h) or none
// (free_body.h).

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <utility>

#include "ppu/bodies/stillness.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

class CoupledBody {
 public:
  CoupledBody(btDiscreteDynamicsWorld& world, SoftBody<3> soft) : world_(world), soft_(std::move(soft)) {}
  virtual ~CoupledBody() = default;
  CoupledBody(const CoupledBody&) = delete;
  CoupledBody& operator=(const CoupledBody&) = delete;

  SoftBody<3>& soft() { return soft_; }
  const SoftBody<3>& soft() const { return soft_; }

  /// Replaces the body by its largest piece and keeps the known rotations. @return the body as it was
  SoftBody<3> become(SoftBody<3> piece) {
    const bool reset = was_reset();
    soft_ = std::move(piece);
    if (!reset) seen_resets_ = soft_.resets();
    return piece;
  }

  /// Whether the body's user has changed it since the last substep.
  bool was_changed() const { return soft_.revision() != seen_revision_; }

  /// Whether the body's user has reset it since then, so that its known rotations are useless.
  bool was_reset() const { return soft_.resets() != seen_resets_; }

  /// Called before the solver: takes what the caller may have done to the body or, mostly to velocities, its particles.
  virtual void begin_substep() = 0;

  /// Whether particles differ from what the solver knows although the body was not changed.
  virtual bool was_pushed() const = 0;

  /// Called after the solver: passes the new velocities to whoever moves the particles.
  virtual void apply(float step) = 0;

  /// Called after Bullet has integrated.
  virtual void end_substep(float step, const std::optional<SleepSettings>& sleep) = 0;

  /// Whether it was too fast to fall asleep at the end of the last substep. A body that was woken counts as moving once it has begun to
  /// move.
  bool moves() const { return stillness_.moves(); }

  virtual bool can_be_touched() const = 0;

  /// Whether it may break, and so become another body with other particles.
  virtual bool can_break() const = 0;

  /// The box around all that can be touched. @pre can_be_touched()
  virtual Bounds<3> box() const = 0;
  /// The box in which the body sleeps, or has slept until the program moved it.
  virtual std::optional<Bounds<3>> box_asleep() const { return std::nullopt; }
  virtual float reach() const = 0;  ///< metres: other soft bodies touch it up to so far outside of that box

  const CollisionFilter& filter() const { return filter_; }
  virtual void set_filter(const CollisionFilter& filter) {
    filter_ = filter;
    rouse();
  }

  /// Wakes the body if it sleeps and may have rested on another body, which was in the box `gone` and has left.
  void lose(const CoupledBody& other, const Bounds<3>& gone) {
    if (!soft_.asleep() || !can_be_touched()) return;
    constexpr float kGive = 1.2f;  // resting bodies are slightly farther apart than they touch
    const Bounds<3> own = box();
    const Eigen::Vector3f reaches = Eigen::Vector3f::Constant(kGive * (reach() + other.reach()));
    if ((own.low - reaches - gone.high).maxCoeff() < 0 && (gone.low - own.high - reaches).maxCoeff() < 0)
      rouse();
  }

  /// Wakes the body. It falls asleep again after it has been still for as long as others must be.
  void rouse() {
    stillness_.begin();
    wake();
  }

 protected:
  virtual void wake() { soft_.set_asleep(false); }
  virtual void fall_asleep() = 0;  ///< at rest, under the present gravity

  void see_changes() {
    seen_revision_ = soft_.revision();
    seen_resets_ = soft_.resets();
  }

  bool falls_another_way() const { return world_.getGravity() != gravity_asleep_; }

  void fall_asleep_when_still(float step, const SleepSettings& settings) {
    count_stillness(step, settings);
    if (stillness_.seconds() >= settings.seconds) fall_asleep_now();
  }

  void count_stillness(float step, const SleepSettings& settings) {
    SC_ASSERT(!soft_.asleep(), "a body that has been still for {} s sleeps", stillness_.seconds());
    stillness_.count(step, real_speed_.value_or(soft_.mean_speed()), settings.speed);
  }

  void fall_asleep_now() {
    for (std::size_t i = 0; i < soft_.velocities().size(); ++i)
      soft_.set_velocity(i, Eigen::Vector3f::Zero());
    fall_asleep();
    gravity_asleep_ = world_.getGravity();
    soft_.set_asleep(true);
  }

  btDiscreteDynamicsWorld& world_;
  SoftBody<3> soft_;
  CollisionFilter filter_;
  Stillness stillness_;
  std::optional<float> real_speed_;  // m/s, in the last substep; none: as the particles' velocities say

 private:
  std::uint32_t seen_revision_ = 0, seen_resets_ = 0;
  btVector3 gravity_asleep_{0, 0, 0};
};

}  // namespace softcell::ppu
