#include <cmath>
#include <stdexcept>
#include <string>

#include "ppu/matching/regions.h"
#include "ppu/matching/stiffness.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {
namespace {

void require(bool in_range, const char* name, float value, const char* range) {
  if (in_range && std::isfinite(value)) return;
  throw std::runtime_error(std::string("a soft body's ") + name + " is " + base::shortest(value) +
                           "; it must be " + range + (in_range ? ", and finite" : ""));
}

}  // namespace

void validate(const SleepSettings& settings) {
  const auto check = [](const char* name, float value) {
    if (!(value >= 0))
      throw std::invalid_argument(std::string("sleep settings: ") + name + " is " + base::shortest(value) +
                                  "; expected is a number from 0 on");
  };
  check("speed", settings.speed);
  check("seconds", settings.seconds);
}

void validate(const SoftBodySettings& s) {
  require(s.cell_size > 0, "cell_size", s.cell_size, "a length in metres above 0");
  if (s.half_width < 0 || s.half_width > kMaxHalfWidth) {
    throw std::runtime_error("a soft body's half_width is " + std::to_string(s.half_width) +
                             "; it must be a number of links from 0 to " + std::to_string(kMaxHalfWidth));
  }
  require(s.density > 0, "density", s.density,
          "a number above 0, in kg/m^3 (of a two-dimensional body in kg/m^2)");
  require(s.alpha >= 0 && s.alpha <= 1, "alpha", s.alpha, "from 0 to 1");
  require(s.damping >= 0 && s.damping <= 1, "damping", s.damping, "from 0 to 1");
  require(s.friction >= 0, "friction", s.friction, "0 or above");
  require(s.restitution >= 0 && s.restitution <= 1, "restitution", s.restitution, "from 0 to 1");
  if (s.frequency) require(*s.frequency >= 0, "frequency", *s.frequency, "in hertz and 0 or above");
  if (s.damping_time)
    require(*s.damping_time >= 0, "damping_time", *s.damping_time, "in seconds and 0 or above");
  if (s.plasticity) {
    const auto& [yield, creep, limit] = *s.plasticity;
    require(yield > 0 && yield <= 1, "yield", yield, "a strain above 0 and at most 1");
    require(creep > 0, "creep", creep, "in 1/s and above 0");
    require(limit > 0, "limit", limit, "a strain above 0");
  }
  if (s.fracture) {
    const auto& [stretch, turn, least_cells] = *s.fracture;
    if (stretch) require(*stretch > 0, "fracture.stretch", *stretch, "a share above 0");
    constexpr float kHalfTurn = 3.1415927f;
    if (turn)
      require(*turn > 0 && *turn <= kHalfTurn, "fracture.turn", *turn,
              "an angle in radians above 0 and at most pi");
    require(least_cells >= 1, "fracture.least_cells", static_cast<float>(least_cells),
            "a number of cells, 1 or above");
  }
}

float SoftBodySettings::alpha_of_step(float step) const {
  SC_ASSERT(step > 0, "a time step of {} s", step);
  return frequency ? static_cast<float>(alpha_from_frequency(*frequency, step)) : alpha;
}

float SoftBodySettings::damping_of_step(float step) const {
  SC_ASSERT(step > 0, "a time step of {} s", step);
  return damping_time ? static_cast<float>(damping_from_time_constant(*damping_time, step)) : damping;
}

}  // namespace softcell::ppu
