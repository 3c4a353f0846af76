#pragma once
// The moving state of one soft body.
//
// No engine here. An engine integrates the particles (see bullet/bullet_soft_bodies.h); what makes them one
// body is SoftBody::pull(), called once per time step.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

template <typename Real>
class ShapeMatcher;

/// Positions and velocities of one body's particles. Used by one thread at a time; allocates nothing after
/// construction. Copy a SoftBody to save it, assign to restore: a change by its user, as those below.
class SoftBody {
 public:
  /// At rest, undeformed, the model's own origin at `position` (metres).
  explicit SoftBody(std::shared_ptr<const SoftBodyModel> model,
                    const Eigen::Vector3f& position = Eigen::Vector3f::Zero());
  SoftBody(const SoftBody& other);
  SoftBody& operator=(const SoftBody& other);
  ~SoftBody();

  const SoftBodyModel& model() const { return *model_; }
  const std::shared_ptr<const SoftBodyModel>& shared_model() const { return model_; }

  std::span<const Eigen::Vector3f> positions() const { return x_; }  ///< metres, of each particle
  const Eigen::Vector3f& position(std::size_t particle) const { return x_[particle]; }
  std::span<const Eigen::Vector3f> velocities() const { return v_; }  ///< m/s, of each particle
  /// The positions as x y z 0, 16 bytes each: for whoever copies them to SPEs or to a graphics card.
  std::span<const Eigen::Vector4f> padded_positions() const { return padded_; }

  // What an engine's coupling does in a time step of `step` seconds, in this order.

  /// Shape matching and damping: changes velocities, conserves momentum, moves nothing.
  /// @throws std::runtime_error  a particle is NaN or infinite; nothing has changed then.
  void pull(float step);
  /// Slows particles down that are faster than `limit` (m/s).
  void limit_speed(float limit);
  /// Integrates the inner particles under `gravity` (m/s^2): v += h g, x += h v. Bullet's own order.
  void advance_inner(float step, const Eigen::Vector3f& gravity);
  /// Takes an outer particle over from the engine.
  void set_particle(std::size_t particle, const Eigen::Vector3f& position, const Eigen::Vector3f& velocity) {
    x_[particle] = position;
    v_[particle] = velocity;
    padded_[particle] = {position.x(), position.y(), position.z(), 0};
  }

  /// What a solver has made of a velocity.
  void set_velocity(std::size_t particle, const Eigen::Vector3f& velocity) { v_[particle] = velocity; }

  /// A body that sleeps is left as it is: no solver steps it. Couplings put bodies to sleep and wake them.
  bool asleep() const { return asleep_; }
  void set_asleep(bool asleep) { asleep_ = asleep; }

  // What its user may do between time steps. Each counts up revision(), by which a coupling notices, and
  // those after which the rotations of the last step say nothing count up resets() too.

  void translate(const Eigen::Vector3f& by);
  /// Back to the undeformed shape at rest, the model's own origin at `position`.
  void reset(const Eigen::Vector3f& position);
  /// Teleports: turns the body about its centre of mass, then moves it. Velocities turn with the body.
  void move_without_force(const Eigen::Quaternionf& rotation, const Eigen::Vector3f& translation);
  /// Back to the undeformed shape, centre, mean orientation and both momenta kept.
  void reset_deformation();
  void add_velocity(const Eigen::Vector3f& dv);                                 ///< m/s, to every particle
  void add_particle_velocity(std::size_t particle, const Eigen::Vector3f& dv);  ///< m/s
  /// m/s, to every particle: adds a turn about the centre of mass, in rad/s.
  void add_angular_velocity(const Eigen::Vector3f& dw);
  std::uint32_t revision() const { return revision_; }
  std::uint32_t resets() const { return resets_; }

  Eigen::Vector3f centre_of_mass() const;    ///< metres
  Eigen::Vector3f linear_momentum() const;   ///< kg m/s
  Eigen::Vector3f angular_momentum() const;  ///< kg m^2/s, about the centre of mass
  Bounds bounds() const;                     ///< of the particles' centres, metres

 private:
  void set_position(std::size_t particle, const Eigen::Vector3f& position);
  void place_at_rest(const Eigen::Vector3f& position);
  void forget_rotations();

  std::shared_ptr<const SoftBodyModel> model_;
  std::vector<Eigen::Vector3f> x_, v_;
  std::vector<Eigen::Vector4f> padded_;  // x_ again
  std::unique_ptr<ShapeMatcher<float>> matcher_;
  std::uint32_t revision_ = 0, resets_ = 0;
  bool asleep_ = false;
};

}  // namespace softcell::ppu
