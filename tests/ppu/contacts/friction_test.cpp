// Friction of what is drawn, against the formula of a block on a slope.

#include <gtest/gtest.h>

#include <cmath>

#include "contact_world.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

/// How far a flat block slides down a slope in 1 s, metres, beside the way that it would go without acceleration.
float slide_of_block(float slope, float friction, int frames_before, SolverFactory* solvers) {
  ContactWorld w({9.81f * std::sin(slope), -9.81f * std::cos(slope), 0}, solvers);
  const SoftBodySettings settings = settings_of(0.1f, 0.7f, 0.3f);
  w.add_floor(friction / settings.friction);
  const SoftBody<3>& block = w.add(make_box({0.6f, 0.2f, 0.6f}, 0.1f), settings, {0, 0.102f, 0});
  w.run(frames_before);
  const float x = block.centre_of_mass().x(), v = block.linear_momentum().x() / block.model().mass();
  w.run(60);
  return block.centre_of_mass().x() - x - v;
}

void expect_coulomb(SolverFactory* solvers) {
  for (const float friction : {0.2f, 0.5f, 1.0f}) {
    // 3 % below the angle of friction it sticks, once it has come to rest.
    EXPECT_NEAR(slide_of_block(std::atan(0.97f * friction), friction, 120, solvers), 0, 1e-3f) << friction;
    for (const float steeper : {1.03f, 1.2f, 1.6f}) {
      const float slope = std::atan(steeper * friction);
      const float way = 0.5f * 9.81f * (std::sin(slope) - friction * std::cos(slope));
      EXPECT_NEAR(slide_of_block(slope, friction, 30, solvers), way, 0.03f * way)
          << friction << ' ' << steeper;
    }
  }
}

TEST(Friction, ABlockSticksOrSlidesDownASlopeByCoulombsLaw) { expect_coulomb(nullptr); }

TEST(Friction, ABlockSticksOrSlidesDownASlopeByCoulombsLawOnSpes) {
  SpeRuntime spes({.spes = 2});
  expect_coulomb(&spes);
}

}  // namespace
}  // namespace softcell::ppu
