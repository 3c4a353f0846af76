#include "ppu/matching/stiffness.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/text.h"

namespace softcell::ppu {

namespace {

void check(bool good, const char* name, double value, const char* expected) {
  if (!good)
    throw std::invalid_argument(std::string(name) + " " + base::shortest(value) + ": expected " + expected);
}

void check_positive(const char* name, double value) {
  check(value > 0 && std::isfinite(value), name, value, "a positive number");
}

}  // namespace

double alpha_from_frequency(double frequency, double step) {
  check(frequency >= 0 && std::isfinite(frequency), "frequency", frequency,
        "0 or a positive number of hertz");
  check_positive("time step", step);
  // alpha = 1 swings once in six steps.
  if (frequency * step >= 1.0 / 6.0) return 1;
  const double half_sine = sine(kPi * frequency * step);
  return std::min(1.0, 4 * half_sine * half_sine);
}

double damping_from_time_constant(double time_constant, double step) {
  check(time_constant >= 0, "damping time constant", time_constant, "0 or a positive number of seconds");
  check_positive("time step", step);
  if (time_constant == 0) return 1;
  return 1 - exponential(-step / time_constant);
}

double specific_modulus(double spacing, double step, double alpha, int half_width) {
  check_positive("lattice spacing", spacing);
  check_positive("time step", step);
  check(alpha >= 0 && alpha <= 1, "alpha", alpha, "0 to 1");
  check(half_width >= 0, "region half width", half_width, "0 or more");
  const double speed = spacing / step;
  return speed * speed * alpha * half_width * (half_width + 1) / 3;
}

}  // namespace softcell::ppu
