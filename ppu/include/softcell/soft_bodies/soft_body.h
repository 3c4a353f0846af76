#pragma once
// A soft body: the model that all bodies of one make share, and the moving state of one of them.
//
// No engine here. An engine integrates the particles (see bullet_coupling.h); what makes them one body is
// SoftBody::pull(), called once per time step.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ppu/bodies/change_count.h"
#include "ppu/lattice/embedding.h"
#include "ppu/reference/shape_matching.h"
#include "skin_job.h"
#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// What a soft body is made like. Only `cell_size` has no default.
///
/// `alpha` and `damping` act per time step, so the same numbers make a stiffer and calmer body with shorter
/// steps. `frequency` and `damping_time` say the same in hertz and seconds and take the step into account.
struct SoftBodySettings {
  float cell_size = 0;    ///< edge of a lattice cell, metres
  int half_width = 2;     ///< of a region, links; stiffness grows with its square; 0..kMaxHalfWidth
  float density = 200;    ///< kg/m^3
  float alpha = 0.5f;     ///< 0..1: the share of the way to its goal that a particle makes up for in one step
  float damping = 0.05f;  ///< 0..1: the share of the deviation from rigid motion taken away in one step
  float friction = 0.6f;  ///< coefficient of the particles; Bullet multiplies it with the other body's
  bool contacts = true;   ///< false: nothing touches the body, whose particles then are all inner ones
  std::optional<float> frequency = {};  ///< Hz, in place of alpha: at which a particle swings about its goal
  std::optional<float> damping_time = {};  ///< s, in place of damping: deviations fall to 1/e in this time

  /// alpha and damping of a time step of `step` seconds. @throws as validate().
  float alpha_of_step(float step) const;
  float damping_of_step(float step) const;

  bool operator==(const SoftBodySettings&) const = default;
};

/// @throws std::runtime_error  a value is out of its range; the sentence names it and the range.
void validate(const SoftBodySettings& settings);

/// All that bodies of one make share. Immutable; safe to read from any thread.
class SoftBodyModel {
 public:
  const SoftBodySettings& settings() const { return settings_; }
  const Lattice& lattice() const { return lattice_; }
  /// Empty for a model made from a lattice alone. For an owner that outlives the model, alias the pointer:
  /// std::shared_ptr<const Embedding>(model, &model->embedding()).
  const Embedding& embedding() const { return embedding_; }
  const std::shared_ptr<const MatchingPlan<float>>& plan() const { return plan_; }
  std::size_t particles() const { return masses_.size(); }
  std::span<const float> masses() const { return masses_; }  ///< kg, of each particle
  float mass() const { return mass_; }                       ///< kg, of the body

  /// Particle numbers, ascending. Outer particles collide, none of a body without contacts: all corners of
  /// the cells at the lattice's boundary, which makes them two deep. One layer would keep things out, but a
  /// body that is pressed flat on a floor would push its second layer, which the mesh hangs on too, through
  /// the first and the floor.
  std::span<const std::uint32_t> outer() const { return outer_; }
  std::span<const std::uint32_t> inner() const { return inner_; }

  /// Radius in metres of the sphere with which an outer particle collides.
  ///
  /// The mesh lies inside its lattice, and every mesh vertex between the eight corners of its cell: while no
  /// particle's centre is below a floor, neither is the mesh. The radius adds nothing but distance between
  /// the mesh and what it lies on. It is as small as contacts work well with, 0.15 cells, the same for all;
  /// the mesh's lowest point comes to rest that much above the floor, plus its own distance to the lattice's
  /// boundary.
  float contact_radius() const { return kContactRadiusInCells * lattice_.spacing; }
  /// The same towards particles of other soft bodies. A particle has to meet a lattice of equal cells
  /// wherever it comes, also in the middle of a face: 2 r > s / sqrt(2), and with something to spare, because
  /// a face gives: at 0.40 cells 5 of 30 pairs of balls came to rest inside each other, at 0.45 none.
  float soft_contact_radius() const { return kSoftContactRadiusInCells * lattice_.spacing; }
  static constexpr float kContactRadiusInCells = 0.15f;
  static constexpr float kSoftContactRadiusInCells = 0.45f;

 private:
  friend std::shared_ptr<const SoftBodyModel> make_soft_body_model(const TriangleMesh&,
                                                                   const SoftBodySettings&);
  friend std::shared_ptr<const SoftBodyModel> make_soft_body_model(Lattice, const SoftBodySettings&);
  SoftBodyModel(Lattice lattice, Embedding embedding, const SoftBodySettings& settings);

  SoftBodySettings settings_;
  Lattice lattice_;
  Embedding embedding_;
  std::vector<float> masses_;
  float mass_;
  std::vector<std::uint32_t> outer_, inner_;
  std::shared_ptr<const MatchingPlan<float>> plan_;
};

/// Covers the mesh with a lattice, finds its regions, embeds the mesh. Deterministic.
/// @throws std::runtime_error  as validate(), voxelize(), find_regions() and embed().
std::shared_ptr<const SoftBodyModel> make_soft_body_model(const TriangleMesh& mesh,
                                                          const SoftBodySettings& settings);

/// A model that nothing is drawn of. @pre settings.cell_size is the lattice's spacing.
/// @throws std::runtime_error  as validate() and find_regions(), and for another cell size.
std::shared_ptr<const SoftBodyModel> make_soft_body_model(Lattice lattice, const SoftBodySettings& settings);

/// Positions and velocities of one body's particles. Used by one thread at a time; allocates nothing after
/// construction. Copy a SoftBody to save it, assign to restore: a change by its user, as those below.
class SoftBody {
 public:
  /// At rest, undeformed, the model's own origin at `position` (metres).
  explicit SoftBody(std::shared_ptr<const SoftBodyModel> model,
                    const Eigen::Vector3f& position = Eigen::Vector3f::Zero());

  const SoftBodyModel& model() const { return *model_; }
  const std::shared_ptr<const SoftBodyModel>& shared_model() const { return model_; }

  /// Metres, of each particle, laid out as the kernels read them: one memcpy hands them over.
  std::span<const spu::SkinCorner> positions() const { return corners_; }
  const Eigen::Vector3f& position(std::size_t particle) const { return x_[particle]; }
  std::span<const Eigen::Vector3f> velocities() const { return v_; }  ///< m/s, of each particle
  const ShapeMatcher<float>& matcher() const { return matcher_; }

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
    corners_[particle] = {position.x(), position.y(), position.z(), 0};
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
  std::uint32_t revision() const { return revision_.count(); }
  std::uint32_t resets() const { return resets_.count(); }

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
  std::vector<spu::SkinCorner> corners_;  // x_ again
  ShapeMatcher<float> matcher_;
  ChangeCount revision_, resets_;
  bool asleep_ = false;
};

}  // namespace softcell::ppu
