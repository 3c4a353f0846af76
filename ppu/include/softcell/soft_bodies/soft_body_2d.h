#pragma once
// A soft body in two dimensions: a lattice with its material, and the moving particles. See soft_body.h.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice_2d.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

template <typename Real, int kDimension>
class BasicMatchingPlan;
template <typename Real>
class ShapeMatcher2d;

/// All that bodies of one make share. Immutable; safe to read from any thread.
class SoftBodyModel2d {
 public:
  const SoftBodySettings& settings() const { return settings_; }  ///< density is in kg/m^2
  const Lattice2d& lattice() const { return lattice_; }
  std::size_t particles() const { return masses_.size(); }
  std::span<const float> masses() const { return masses_; }  ///< kg, of each particle
  float mass() const { return mass_; }                       ///< kg, of the body

  /// Particle numbers, ascending. Outer particles collide: those not surrounded by four cells.
  std::span<const std::uint32_t> outer() const { return outer_; }
  std::span<const std::uint32_t> inner() const { return inner_; }

  /// Radius in metres of the circle with which an outer particle collides.
  float contact_radius() const { return contact_radius_in_cells_ * lattice_.spacing; }

  /// Circles of half a cell touch each other: nothing gets between the particles of a body, and things meet
  /// it half a cell before they meet what is drawn. Smaller ones let small things in.
  static constexpr float kContactRadiusInCells = 0.5f;

  /// For solvers: constants of its particles and regions.
  const std::shared_ptr<const BasicMatchingPlan<float, 2>>& plan() const { return plan_; }

 private:
  friend std::shared_ptr<const SoftBodyModel2d> make_soft_body_model(Lattice2d, const SoftBodySettings&,
                                                                     float);
  SoftBodyModel2d(Lattice2d lattice, const SoftBodySettings& settings, float contact_radius_in_cells);

  SoftBodySettings settings_;
  Lattice2d lattice_;
  std::vector<float> masses_;
  float mass_;
  float contact_radius_in_cells_;
  std::vector<std::uint32_t> outer_, inner_;
  std::shared_ptr<const BasicMatchingPlan<float, 2>> plan_;
};

/// @param contact_radius_in_cells  above 0 and at most 1.
/// @throws std::runtime_error  as validate() and find_regions(); a cell size that is not the lattice's
/// spacing; a contact radius out of range.
std::shared_ptr<const SoftBodyModel2d> make_soft_body_model(
    Lattice2d lattice, const SoftBodySettings& settings,
    float contact_radius_in_cells = SoftBodyModel2d::kContactRadiusInCells);

/// Positions and velocities of one body's particles. Used by one thread at a time; allocates nothing after
/// construction. Copy a SoftBody2d to save it, assign to restore: a change by its user, as those below.
class SoftBody2d {
 public:
  /// At rest, undeformed, the model's own origin at `position` (metres).
  explicit SoftBody2d(std::shared_ptr<const SoftBodyModel2d> model,
                      const Eigen::Vector2f& position = Eigen::Vector2f::Zero());
  SoftBody2d(const SoftBody2d& other);
  SoftBody2d& operator=(const SoftBody2d& other);
  ~SoftBody2d();

  const SoftBodyModel2d& model() const { return *model_; }
  const std::shared_ptr<const SoftBodyModel2d>& shared_model() const { return model_; }
  std::span<const Eigen::Vector2f> positions() const { return x_; }   ///< metres, of each particle
  std::span<const Eigen::Vector2f> velocities() const { return v_; }  ///< m/s, of each particle

  // What an engine's coupling does in a time step of `step` seconds, in this order: see SoftBody.

  void pull(float step);
  void limit_speed(float limit);
  void advance_inner(float step, const Eigen::Vector2f& gravity);
  /// Inner particles that have left the box around the outer ones go back to its edge, and lose the velocity
  /// with which they left: nothing else keeps those of a crushed body from sinking through the ground.
  void keep_inner_inside();
  void set_particle(std::size_t particle, const Eigen::Vector2f& position, const Eigen::Vector2f& velocity) {
    x_[particle] = position;
    v_[particle] = velocity;
  }

  // What its user may do between time steps. Each counts up revision(), by which a coupling notices.

  void translate(const Eigen::Vector2f& by);
  /// Back to the undeformed shape at rest, the model's own origin at `position`.
  void reset(const Eigen::Vector2f& position);
  void add_velocity(const Eigen::Vector2f& dv);                                 ///< m/s, to every particle
  void add_particle_velocity(std::size_t particle, const Eigen::Vector2f& dv);  ///< m/s
  std::uint32_t revision() const { return revision_; }

  Eigen::Vector2f centre_of_mass() const;   ///< metres
  Eigen::Vector2f linear_momentum() const;  ///< kg m/s
  float angular_momentum() const;           ///< kg m^2/s, about the centre of mass

  /// The longest distance of a particle from where the body's best rigid motion would have it, in metres.
  float deformation() const;

 private:
  void place_at_rest(const Eigen::Vector2f& position);

  std::shared_ptr<const SoftBodyModel2d> model_;
  std::vector<Eigen::Vector2f> x_, v_;
  std::unique_ptr<ShapeMatcher2d<float>> matcher_;
  std::uint32_t revision_ = 0;
};

}  // namespace softcell::ppu
