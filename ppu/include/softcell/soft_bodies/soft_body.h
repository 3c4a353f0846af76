#pragma once
// The moving state of one soft body.
//
// No engine here. An engine integrates the particles (see bullet/bullet_soft_bodies.h and
// box2d/box2d_soft_bodies.h); what makes them one body is SoftBody::pull(), called once per time step.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

template <typename Real, int kDimension>
class ShapeMatcher;

/// What turns: in the plane by an angle and about the one axis that there is, in space about any.
template <int kDimension>
struct Turning;
template <>
struct Turning<2> {
  using Rotation = Eigen::Rotation2Df;
  using AxialVector = float;  ///< angular velocity or momentum, counter-clockwise above 0
};
template <>
struct Turning<3> {
  using Rotation = Eigen::Quaternionf;
  using AxialVector = Eigen::Vector3f;
};

/// Positions and velocities of one body's particles. Used by one thread at a time; allocates nothing after
/// construction. Copy a SoftBody to save it, assign to restore: a change by its user, as those below.
/// @tparam kDimension  2 or 3
template <int kDimension>
class SoftBody {
 public:
  using Vector = Eigen::Vector<float, kDimension>;
  using Rotation = typename Turning<kDimension>::Rotation;
  using AxialVector = typename Turning<kDimension>::AxialVector;

  /// At rest, undeformed, the model's own origin at `position` (metres).
  explicit SoftBody(std::shared_ptr<const SoftBodyModel<kDimension>> model,
                    const Vector& position = Vector::Zero());
  SoftBody(const SoftBody& other);
  SoftBody& operator=(const SoftBody& other);
  ~SoftBody();

  const SoftBodyModel<kDimension>& model() const { return *model_; }
  const std::shared_ptr<const SoftBodyModel<kDimension>>& shared_model() const { return model_; }

  std::span<const Vector> positions() const { return x_; }  ///< metres, of each particle
  const Vector& position(std::size_t particle) const { return x_[particle]; }
  std::span<const Vector> velocities() const { return v_; }  ///< m/s, of each particle
  /// The positions as x y z 0, 16 bytes each: for whoever copies them to SPEs or to a graphics card.
  std::span<const Eigen::Vector4f> padded_positions() const requires(kDimension == 3) { return padded_; }

  // What an engine's coupling does in a time step of `step` seconds, in this order.

  /// Shape matching and damping: changes velocities, conserves momentum, moves nothing.
  /// @throws std::runtime_error  a particle is NaN or infinite; nothing has changed then.
  void pull(float step);
  /// Slows particles down that are faster than `limit` (m/s).
  void limit_speed(float limit);
  /// Integrates the inner particles under `gravity` (m/s^2): v += h g, x += h v. The engines' own order.
  void advance_inner(float step, const Vector& gravity);
  /// Inner particles that have left the box around the outer ones go back to its edge, and lose the velocity
  /// with which they left: nothing else keeps those of a crushed body from sinking through the ground. For
  /// bodies whose outer particles are one layer only, as in two dimensions.
  void keep_inner_inside();
  /// Takes an outer particle over from the engine.
  void set_particle(std::size_t particle, const Vector& position, const Vector& velocity) {
    x_[particle] = position;
    v_[particle] = velocity;
    if constexpr (kDimension == 3) padded_[particle] = {position.x(), position.y(), position.z(), 0};
  }

  /// What a solver has made of a velocity.
  void set_velocity(std::size_t particle, const Vector& velocity) { v_[particle] = velocity; }

  /// A body that sleeps is left as it is: no solver steps it. Couplings put bodies to sleep and wake them.
  bool asleep() const { return asleep_; }
  void set_asleep(bool asleep) { asleep_ = asleep; }

  // What its user may do between time steps. Each counts up revision(), by which a coupling notices, and
  // those after which the rotations of the last step say nothing count up resets() too.

  void translate(const Vector& by);
  /// Back to the undeformed shape at rest, the model's own origin at `position`.
  void reset(const Vector& position);
  /// Teleports: turns the body about its centre of mass, then moves it. Velocities turn with the body.
  void move_without_force(const Rotation& rotation, const Vector& translation);
  /// Back to the undeformed shape, centre, mean orientation and both momenta kept.
  void reset_deformation();
  void add_velocity(const Vector& dv);                                 ///< m/s, to every particle
  void add_particle_velocity(std::size_t particle, const Vector& dv);  ///< m/s
  /// m/s, to every particle: adds a turn about the centre of mass, in rad/s.
  void add_angular_velocity(const AxialVector& dw);
  std::uint32_t revision() const { return revision_; }
  std::uint32_t resets() const { return resets_; }

  Vector centre_of_mass() const;         ///< metres
  Vector linear_momentum() const;        ///< kg m/s
  AxialVector angular_momentum() const;  ///< kg m^2/s, about the centre of mass
  Bounds<kDimension> bounds() const;     ///< of the particles' centres, metres
  /// The longest distance of a particle from where the body's best rigid motion would have it, in metres.
  float deformation() const;

 private:
  void set_position(std::size_t particle, const Vector& position);
  void place_at_rest(const Vector& position);
  void forget_rotations();

  std::shared_ptr<const SoftBodyModel<kDimension>> model_;
  std::vector<Vector> x_, v_;
  std::vector<Eigen::Vector4f> padded_;  // x_ again, in three dimensions
  std::unique_ptr<ShapeMatcher<float, kDimension>> matcher_;
  std::uint32_t revision_ = 0, resets_ = 0;
  bool asleep_ = false;
};

extern template class SoftBody<2>;
extern template class SoftBody<3>;

}  // namespace softcell::ppu
