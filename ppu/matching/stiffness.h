#pragma once
// Converts between alpha, half-width and time step and the units that users know. All results have the same bits on
// every host.

namespace softcell::ppu {

/// The alpha that makes a particle swing about a fixed goal at `frequency` hertz with time steps of `step`
/// seconds: min(1, 4 sin^2(pi f h)), and 1 for anything faster than alpha = 1 can be (a sixth of the step
/// rate).
/// @throws std::invalid_argument  frequency negative or not finite; step not positive and finite.
double alpha_from_frequency(double frequency, double step);

/// The region damping per step, 0..1, that takes deviations from rigid motion down by 1/e in `time_constant`
/// seconds: 1 - exp(-h / tau); 1 for a time constant of 0.
/// @throws std::invalid_argument  time constant negative or NaN (infinity: no damping); step not positive and
/// finite.
double damping_from_time_constant(double time_constant, double step);

/// Young's modulus over density, in m^2/s^2, of the bulk of a body: E / rho = (s/h)^2 alpha w (w+1) / 3, for
/// waves long against the regions. Poisson's ratio is 0.
/// @param spacing  s, metres    @param step  h, seconds    @param alpha  0..1    @param half_width  w, links
/// @throws std::invalid_argument  spacing or step not positive and finite, alpha outside 0..1, half width
/// negative.
double specific_modulus(double spacing, double step, double alpha, int half_width);

}  // namespace softcell::ppu
