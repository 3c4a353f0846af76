#pragma once
// Settings of soft bodies in two dimensions and three, and of their sleep.

#include <cstdint>
#include <optional>

namespace softcell::ppu {

/// How much of a deformation remains. Where the strain is above the yield, the rest shape flows towards the present shape. The strain of a
/// bar that is pulled is its elongation; that of a bent bar is half its thickness times its curvature. The volume at rest stays the same.
struct Plasticity {
  float yield = 0.1f;  ///< above 0, at most 1: the strain below which a deformation is elastic
  float creep = 10;    ///< 1/s, above 0: the strain above the yield falls to 1/e in 1 / creep seconds
  /// Above 0: at rest no edge of a cell gets longer than 1 + limit cells, or shorter than 1 / (1 + limit) cells.
  float limit = 1;

  bool operator==(const Plasticity&) const = default;
};

/// When a body breaks, along the faces between its cells (fracture.h). A face breaks as soon as one of the two measures exceeds its limit.
/// A measure without a limit breaks nothing. The limits are for a strength of 1; a model can be weaker or stronger in some of its cells.
struct Fracture {
  /// Above 0: how far the middles of two neighbouring cells may move apart, as a share of a cell's edge.
  std::optional<float> stretch = {};
  /// Radians, above 0, up to pi: how far two neighbouring cells may turn against each other.
  std::optional<float> turn = {};
  /// Cells, 1 and up. When the body breaks or is cut, pieces of fewer cells vanish and take their mass and momenta with them. The largest
  /// piece, which is the body itself, stays whatever its size. An attachment whose patch is in a piece that vanishes ends as if its body
  /// were removed (EndedAttachment::Reason::kGone). With 1 nothing vanishes.
  std::uint32_t least_cells = 1;

  bool operator==(const Fracture&) const = default;
};

/// Detail, material and contacts of a soft body. Only `cell_size` has no default.
///
/// `alpha` and `damping` act per time step, so with shorter steps the same numbers make a body stiffer and more damped. `frequency` and
/// `damping_time` say the same in hertz and seconds and take the step into account.
struct SoftBodySettings {
  float cell_size = 0;    ///< edge of a lattice cell, metres
  int half_width = 2;     ///< of a region, links; stiffness grows with its square; 0..16
  float density = 200;    ///< kg/m^3; kg/m^2 in two dimensions
  float alpha = 0.5f;     ///< 0..1: the share of the way to its goal that a particle makes up for in one step
  float damping = 0.05f;  ///< 0..1: the share of the deviation from rigid motion taken away in one step
  /// Coefficient of friction, 0 and up. In Bullet it is multiplied by that of the other body; Box2D takes the geometric mean of both.
  float friction = 0.6f;
  /// 0..1: the fraction of its speed with which the body as a whole leaves what it hits. In Bullet it is multiplied by that of the other
  /// body; Box2D takes the larger one.
  float restitution = 0;
  bool contacts = true;  ///< false: nothing touches the body, and all its particles are inner ones
  /// false: the body may pass through itself; with spheres or circles it always may. Pieces that break off it still touch each other.
  bool self_contacts = true;
  std::optional<float> frequency = {};  ///< Hz, in place of alpha: at which a particle swings about its goal
  std::optional<float> damping_time = {};     ///< s, in place of damping: deviations fall to 1/e in this time
  std::optional<Plasticity> plasticity = {};  ///< none: the body is elastic. Up to 4,096 particles
  std::optional<Fracture> fracture = {};      ///< none: it breaks only where a program cuts it

  /// alpha of a time step of `step` seconds, above 0: `alpha`, or computed from `frequency`.
  float alpha_of_step(float step) const;
  /// damping of a time step of `step` seconds, above 0: `damping`, or computed from `damping_time`.
  float damping_of_step(float step) const;

  bool operator==(const SoftBodySettings&) const = default;
};

/// When bodies fall asleep. A sleeping body costs its solver nothing, and its coupling next to nothing.
struct SleepSettings {
  float speed = 0.05f;  ///< m/s, 0 or above: a body rests while its mean_speed() is below this
  float seconds = 1;    ///< 0 or above: a body that has rested for this time falls asleep
};
/// @throws std::invalid_argument  a value is negative or NaN; the message names it.
void validate(const SleepSettings& settings);

/// @throws std::runtime_error  a value is out of its range; the message names the value and the range.
void validate(const SoftBodySettings& settings);

}  // namespace softcell::ppu
