#pragma once
// One soft body in a Box2D world, with any kind of contacts: circles (circle_body.h), or its drawn surface. Box2D does not know of a body
// of the latter kind: surface_contacts_2d.h moves it.

#include <box2d/b2_body.h>
#include <box2d/b2_world.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "ppu/bodies/stillness.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

class Box2dBody {
 public:
  Box2dBody(b2World& world, SoftBody<2> soft);
  virtual ~Box2dBody() = default;
  Box2dBody(const Box2dBody&) = delete;
  Box2dBody& operator=(const Box2dBody&) = delete;

  bool can_break() const { return true; }
  SoftBody<2>& soft() { return soft_; }
  const SoftBody<2>& soft() const { return soft_; }
  const CollisionFilter& filter() const { return filter_; }
  virtual void set_filter(const CollisionFilter& filter) { filter_ = filter; }
  /// Its b2Bodies, in the order of SoftBodyModel::outer(); empty if Box2D does not know of it.
  virtual std::span<b2Body* const> particles() const { return {}; }
  /// @param number  of a particle in the body  @return  null: an inner particle, or Box2D does not know of the body
  virtual b2Body* particle(std::uint32_t number) const;

  /// Whether a break or an assignment has given it another model: its b2Bodies still belong to the old one.
  bool is_of_other_model() const { return model_ != soft_.shared_model(); }
  /// Gives it the b2Bodies of its model, at its place. @pre no step of Box2D is under way
  void follow_model();

  /// Whether the body's user has changed it since the last step.
  bool was_changed() const { return soft_.revision() != seen_revision_; }
  /// Whether the body's user has reset it since then, so that its known rotations are useless.
  bool was_reset() const { return soft_.resets() != seen_resets_; }
  /// Whether particles differ from what was gathered last, or a sleeping body has a reason to wake.
  virtual bool was_pushed() const { return soft_.asleep() && was_disturbed(); }

  /// Called before the solver: takes what the body's user may have done to it, or to its particles in Box2D.
  void begin_step();
  /// The world's origin has moved. That changes nothing for the body: it goes on sleeping. @param by  metres, added to all positions
  virtual void shift(const Eigen::Vector2f& by);
  /// Called between steps: takes over particles that their user has moved or pushed in Box2D, as begin_step() does.
  void take_over_particles();
  /// Moves a particle without changing its velocity. @param particle  its number in the body  @param way  metres
  void move_particle(std::size_t particle, const Eigen::Vector2f& way);
  /// Called after the solver: passes the new velocities to whoever integrates.
  virtual void hand_over(float /*step*/) {}
  /// Called after Box2D's step.
  virtual void end_step(float step);

  /// Adds a step to the time for which the body was slower than `speed` (m/s).
  void count_stillness(float step, float speed);
  /// @param speed  m/s: with which the particles of a crushed body have really moved in this step; none of any other body
  void set_real_speed(const std::optional<float>& speed) { real_speed_ = speed; }
  float still_for() const { return stillness_.seconds(); }  ///< seconds
  /// Whether it was too fast to fall asleep at the end of the last step.
  bool moves() const { return stillness_.moves(); }
  void fall_asleep();
  /// Wakes the body. It falls asleep again after it has been still for as long as at first.
  void wake();

 protected:
  /// Whether gravity has changed since it fell asleep, or Box2D has woken a particle.
  virtual bool was_disturbed() const;
  virtual void exchange_particles() {}                      ///< called when it has another model
  virtual void gather_particles() {}                        ///< reads them from Box2D
  virtual void place_particles() {}                         ///< writes the body's places and settings
  virtual void place_particle(std::size_t /*particle*/) {}  ///< likewise, for one that may be an inner one
  virtual void set_particles_awake(bool /*awake*/) {}

  b2World& world_;
  SoftBody<2> soft_;
  std::shared_ptr<const SoftBodyModel<2>> model_;  // the model of its b2Bodies
  CollisionFilter filter_;

 private:
  std::uint32_t seen_revision_ = 0, seen_resets_ = 0;
  Stillness stillness_;
  std::optional<float> real_speed_;  // m/s, in the last step; none: as the particles' velocities say
  b2Vec2 gravity_asleep_{0, 0};
};

/// Whether a world has a body. It may have been destroyed, so it is not read.
bool has_body(const b2World& world, const b2Body* body);
/// Whether Box2D simulates a rigid body's own motion: a disabled body stands still, whatever its velocity.
inline bool is_simulated(const b2Body& rigid) {
  return rigid.IsEnabled() && rigid.GetType() == b2_dynamicBody;
}
/// Whether a body that Box2D does not simulate stays where it is, unless the program moves it by its place.
inline bool stands_still(const b2Body& rigid) {
  SC_ASSERT(!is_simulated(rigid), "a body of {} kg moves by itself", rigid.GetMass());
  return !rigid.IsEnabled() || (rigid.GetLinearVelocity() == b2Vec2_zero && rigid.GetAngularVelocity() == 0);
}
/// 1/kg; 0: it has no fixture with a density, so that impulses do not move it. @pre it is dynamic
float inverse_mass_of(const b2Body& body);
/// What forces add to a rigid body's velocities in a step.
struct VelocityGain {
  b2Vec2 linear{0, 0};  ///< m/s
  float angular = 0;    ///< radians/s
};

/// What gravity (m/s^2) and the forces and torques that the program has applied to a body will add in a step of `step` seconds, as Box2D
/// integrates them. Nothing for bodies that are not dynamic, or have no mass.
VelocityGain velocity_gain(const b2Body& body, const b2Vec2& gravity, float step);
/// 1/(kg m^2), about its centre of mass; 0: it cannot rotate. @pre it is dynamic
float inverse_inertia_of(const b2Body& body);

inline bool is_same(const b2Transform& a, const b2Transform& b) {
  return a.p == b.p && a.q.s == b.q.s && a.q.c == b.q.c;
}
inline b2Vec2 to_box2d(const Eigen::Vector2f& v) { return {v.x(), v.y()}; }
inline Eigen::Vector2f to_eigen(const b2Vec2& v) { return {v.x, v.y}; }

}  // namespace softcell::ppu
