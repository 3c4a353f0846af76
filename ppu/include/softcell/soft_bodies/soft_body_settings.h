#pragma once
// What a soft body is made like, in two dimensions and three, and when it may sleep.

#include <optional>

namespace softcell::ppu {

/// What a soft body is made like. Only `cell_size` has no default.
///
/// `alpha` and `damping` act per time step, so the same numbers make a stiffer and calmer body with shorter
/// steps. `frequency` and `damping_time` say the same in hertz and seconds and take the step into account.
struct SoftBodySettings {
  float cell_size = 0;    ///< edge of a lattice cell, metres
  int half_width = 2;     ///< of a region, links; stiffness grows with its square; 0..16
  float density = 200;    ///< kg/m^3; kg/m^2 in two dimensions
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

/// When bodies may sleep. A body at rest costs its coupling next to nothing then, and its solver nothing.
struct SleepSettings {
  float speed = 0.05f;  ///< m/s: slower than this are all particles of a body that rests
  float seconds = 1;    ///< for so long
};

/// @throws std::runtime_error  a value is out of its range; the sentence names it and the range.
void validate(const SoftBodySettings& settings);

}  // namespace softcell::ppu
