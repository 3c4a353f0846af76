#pragma once
// The moving state of one soft body, without an engine.
//
// An engine integrates the particles (bullet/bullet_soft_bodies.h, box2d/box2d_soft_bodies.h). SoftBody::pull(), which is called once per
// time step, keeps them together as one body.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

template <typename Real, int kDimension>
class ShapeMatcher;
template <int kDimension>
class LostMomenta;
template <int kDimension>
class RestShape;

/// Rotations and angular velocities in two dimensions and three.
template <int kDimension>
struct Turning;
/// In two dimensions.
template <>
struct Turning<2> {
  using Rotation = Eigen::Rotation2Df;  ///< by an angle in radians, counter-clockwise above 0
  using AxialVector = float;            ///< angular velocity or momentum, counter-clockwise above 0
};
/// In three dimensions.
template <>
struct Turning<3> {
  using Rotation = Eigen::Quaternionf;  ///< of any length but 0
  using AxialVector = Eigen::Vector3f;  ///< angular velocity or momentum, along the axis, right-handed
};

/// Positions and velocities of one body's particles. One thread at a time uses it. It allocates nothing after
/// construction, except when it yields (soft_body_settings.h, Plasticity).
///
/// To save a body's state, copy the SoftBody; to restore the state, assign the copy. An assignment counts as a change by the user, like the
/// functions below. To save it in a file, write positions(), velocities(), own_rest() and, if they have changed, settings(); set_state(),
/// set_rest_positions() and set_material() restore them.
/// @tparam kDimension  2 or 3
template <int kDimension>
class SoftBody {
 public:
  using Vector = Eigen::Vector<float, kDimension>;
  using Rotation = typename Turning<kDimension>::Rotation;
  using AxialVector = typename Turning<kDimension>::AxialVector;

  /// A body at rest, undeformed, the model's own origin at `position` (metres). @pre the model is not null
  explicit SoftBody(std::shared_ptr<const SoftBodyModel<kDimension>> model,
                    const Vector& position = Vector::Zero());
  /// Copies the whole state of the other, with the rotations of its regions.
  SoftBody(const SoftBody& other);
  /// Copies the whole state of the other, which may have another model. Increments revision() and resets().
  SoftBody& operator=(const SoftBody& other);
  /// Moves the state out of the other, which can only be destroyed afterwards.
  SoftBody(SoftBody&& other) noexcept;
  /// Exchanges the states of both bodies. Increments revision() and resets() of both, as a copying assignment does.
  SoftBody& operator=(SoftBody&& other) noexcept;
  ~SoftBody();

  /// The data that the body shares with all bodies of its kind. Assigning a body of another model changes it.
  const SoftBodyModel<kDimension>& model() const { return *model_; }
  /// The same, for code that needs the model longer than the body lives.
  const std::shared_ptr<const SoftBodyModel<kDimension>>& shared_model() const { return model_; }

  /// Detail, material and contacts of this body: its model's settings, until set_material() changes them.
  const SoftBodySettings& settings() const { return settings_; }

  std::span<const Vector> positions() const { return x_; }                     ///< metres, of each particle
  const Vector& position(std::size_t particle) const { return x_[particle]; }  ///< metres
  std::span<const Vector> velocities() const { return v_; }                    ///< m/s, of each particle
  /// The positions as x y z 0 in metres, 16 bytes each, ready to be copied to SPEs or to a graphics card.
  std::span<const Eigen::Vector4f> padded_positions() const requires(kDimension == 3) { return padded_; }

  // For solvers, in each time step of `step` seconds: pull() or set_pulled_velocities(), then flow().

  /// Shape matching and damping: changes velocities, conserves momentum and angular momentum, moves nothing.
  /// @throws std::runtime_error  a particle is NaN or infinite; nothing has changed then.
  /// @throws std::invalid_argument  the step is not above 0 and finite
  void pull(float step);
  /// Called instead of pull() by a solver that has computed shape matching and damping from positions() and velocities(). Every
  /// fourth call also restores the momenta that the solver has lost by rounding since the last such call.
  /// @param velocity_of  returns particle i's velocity in m/s for each i
  template <typename VelocityOf>
  void set_pulled_velocities(const VelocityOf& velocity_of) {
    for (std::size_t i = 0; i < pulled_.size(); ++i) pulled_[i] = velocity_of(i);
    end_pull();
  }
  /// Lets a plastic body flow: changes its rest shape. Every kPlasticSteps-th call looks at the strains. If the body may yield, another
  /// thread computes the flow, and the call kFlowSteps steps later applies the result, for which it may have to wait, unless the body has
  /// sprung back so far that this would add energy. Only such steps allocate memory.
  /// @param stretch  by how much distances between particles differ from those of the rest shape, if the solver has measured that. It
  ///                 saves most looks and does not change results. None: not measured
  /// @pre step, in seconds, is above 0 and finite
  void flow(float step, std::optional<float> stretch = {});
  /// Whether the next flow() looks at the strains.
  bool will_look() const;
  static constexpr int kPlasticSteps = 4, kFlowSteps = 1;

  // For couplings, after the solver, in each time step.

  /// Slows particles down that are faster than `limit` (m/s). @pre limit >= 0
  void limit_speed(float limit);
  /// Integrates the inner particles under `gravity` (m/s^2): v += h g, x += h v. The engines' own order.
  /// @param step  seconds @pre it is above 0 and finite
  void advance_inner(float step, const Vector& gravity);
  /// Moves inner particles that have left the box around the outer ones back to its edge, and removes the
  /// velocity with which they left. Nothing else keeps the inner particles of a crushed body from sinking
  /// through the ground. For bodies with one layer of outer particles, as in two dimensions.
  void keep_inner_inside();
  /// Sets a particle to a state that an engine or a coupling has computed: metres, m/s. @pre particle < model().particles()
  void set_particle(std::size_t particle, const Vector& position, const Vector& velocity);

  // For couplings, at any time between two solver steps.

  /// Sets this body, a piece, to the state that its particles had in the whole body: positions, velocities, material, rest shape,
  /// rotations of regions.
  /// @param whole  the body that broke   @param particle_of  for each particle of this body, its number in the whole
  /// @param centre  whole.precise_centre_of_mass(), which all its pieces need
  /// @pre this body's model is a piece of the whole's; particle_of has a number below whole.model().particles() for each particle
  void inherit_state(const SoftBody& whole, std::span<const std::uint32_t> particle_of,
                     const Eigen::Vector<double, kDimension>& centre);

  /// Sets a particle's velocity (m/s), which a coupling has computed. @pre particle < model().particles()
  void set_velocity(std::size_t particle, const Vector& velocity);
  /// Puts the body to sleep or wakes it, without a change of its velocities.
  void set_asleep(bool asleep);

  // For the user, between time steps. Each of these functions increments revision(), which tells a coupling of the
  // change. Functions that make the rotations of the last step useless also increment resets().

  /// Changes stiffness, damping, friction, restitution, plasticity and fracture from the next time step on.
  /// @throws std::runtime_error  as validate(); the model has too many particles for plasticity; nothing has changed then
  /// @pre cell_size, half_width, density and contacts are the model's
  void set_material(const SoftBodySettings& settings);
  void translate(const Vector& by);  ///< metres @pre it is finite
  /// Sets the positions (metres) and velocities (m/s) of all particles, for example those of a saved game.
  /// @throws std::runtime_error  there are more or fewer of them than particles, or one is not finite; nothing has changed then
  void set_state(std::span<const Vector> positions, std::span<const Vector> velocities);
  /// Puts the body back into the model's shape, at rest, with the model's own origin at `position` (metres). @pre it is finite
  void reset(const Vector& position);
  /// Teleports the body: rotates it about its centre of mass, then moves it by `translation` (metres). Velocities rotate with the body.
  /// @pre the translation is finite
  void move_without_force(const Rotation& rotation, const Vector& translation);
  /// Puts the body back into the model's shape, also a plastic body. Keeps its centre, mean orientation and both momenta.
  void reset_deformation();
  /// Gives the body another rest shape, for example that of a saved body: the position of each particle in metres, in any frame.
  /// @throws std::runtime_error  a position is not finite; there are more or fewer positions than particles; a cell is flat, turned inside
  /// out (as all are in a mirrored shape) or has less than half of its volume in the model; the model has too many particles for plasticity
  void set_rest_positions(std::span<const Vector> rest);
  /// In m/s, to every particle. @pre it is finite
  void add_velocity(const Vector& dv);
  /// In m/s. @pre particle < model().particles(); dv is finite
  void add_particle_velocity(std::size_t particle, const Vector& dv);
  /// Adds a rotation about the centre of mass, in rad/s, to every particle's velocity. @pre it is finite
  void add_angular_velocity(const AxialVector& dw);

  // The state of the body now. These functions change nothing.

  /// Whether the body sleeps. Solvers do not step a sleeping body. Couplings put bodies to sleep and wake them.
  bool asleep() const { return asleep_; }
  /// Whether the body has a rest shape of its own, because it has yielded or set_rest_positions() gave it one.
  bool has_own_rest() const;
  /// The rest shape: metres, of each particle; its centre of mass is that of the model at rest.
  std::vector<Vector> rest_positions() const;
  /// The body's own rest shape without a copy; empty if the body has its model's rest shape. Valid until the rest shape changes.
  std::span<const Vector> own_rest() const;
  std::uint32_t rest_revision() const { return rest_revision_; }  ///< how often the rest shape has changed
  /// For solvers: the constants of the body's rest shape, its model's or its own.
  std::shared_ptr<const MatchingPlan<float, kDimension>> plan() const;
  std::uint32_t revision() const { return revision_; }  ///< how often its user has changed the body
  std::uint32_t resets() const { return resets_; }  ///< how often it was teleported or put back into shape

  Vector centre_of_mass() const;                                     ///< metres
  Eigen::Vector<double, kDimension> precise_centre_of_mass() const;  ///< the same, not rounded
  Vector linear_momentum() const;                                    ///< kg m/s
  AxialVector angular_momentum() const;                              ///< kg m^2/s, about the centre of mass
  /// m/s: sqrt(2 E / m) with the kinetic energy E and the mass m, the root mean square of the particles' speeds weighted by mass.
  float mean_speed() const;
  Bounds<kDimension> bounds() const;  ///< the box around the particles' centres, metres
  /// Metres: the largest distance between a particle and its place in the rest shape, after the best rigid motion of that shape.
  float deformation() const;

 private:
  void set_position(std::size_t particle, const Vector& position);
  void turn_velocities(const AxialVector& dw);
  void place_at_rest(const Vector& position);
  void forget_rotations();
  void end_pull();
  void set_rest(std::unique_ptr<RestShape<kDimension>> rest);
  void adopt_rest(std::unique_ptr<RestShape<kDimension>> rest);
  void read_flow();

  std::shared_ptr<const SoftBodyModel<kDimension>> model_;
  SoftBodySettings settings_;
  std::vector<Vector> x_, v_;
  std::vector<Vector> pulled_;           // results of pull(); end_pull() makes them v_
  std::vector<Eigen::Vector4f> padded_;  // x_ again, in three dimensions
  std::unique_ptr<ShapeMatcher<float, kDimension>> matcher_;
  std::unique_ptr<LostMomenta<kDimension>> lost_;
  std::unique_ptr<RestShape<kDimension>> rest_;  // null: the body is elastic, or was never looked at
  int steps_since_look_ = 0;
  std::uint32_t revision_ = 0, resets_ = 0, rest_revision_ = 0;
  bool asleep_ = false;
};

extern template class SoftBody<2>;
extern template class SoftBody<3>;

}  // namespace softcell::ppu
