#include "tilt.h"

#include <algorithm>
#include <numbers>

#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

constexpr double kTiltGrowsFor = 3;  // seconds

}  // namespace

Eigen::Matrix3f tilted_by(double about_x, double about_z) {
  const auto sx = static_cast<float>(ppu::sine(about_x)), cx = static_cast<float>(ppu::cosine(about_x));
  const auto sz = static_cast<float>(ppu::sine(about_z)), cz = static_cast<float>(ppu::cosine(about_z));
  Eigen::Matrix3f turn_x, turn_z;
  turn_x << 1, 0, 0, 0, cx, -sx, 0, sx, cx;
  turn_z << cz, -sz, 0, sz, cz, 0, 0, 0, 1;
  return turn_z * turn_x;
}

Eigen::Matrix3f tilt_at(const TiltScript& script, double time) {
  SC_ASSERT(script.period_x > 0 && script.period_z > 0, "a tilt with periods of {} s and {} s",
            script.period_x, script.period_z);
  const double grown = std::clamp((time - double{script.begin}) / kTiltGrowsFor, 0.0, 1.0);
  const auto angle = [&](float amplitude, float period) {
    const double phase = 2 * std::numbers::pi * (time - double{script.begin}) / double{period};
    return grown * double{amplitude} * ppu::sine(phase);
  };
  return tilted_by(angle(script.amplitude_x, script.period_x), angle(script.amplitude_z, script.period_z));
}

}  // namespace softcell::demos
