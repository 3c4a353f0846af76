#include "ppu/bodies/stillness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {
namespace {

constexpr float kSubstep = 1.0f / 120, kSpeed = 0.05f;

float seconds_until_rest(Stillness& stillness, float speed, float wanted, int most) {
  for (int i = 1; i <= most; ++i) {
    stillness.count(kSubstep, speed, kSpeed);
    if (stillness.seconds() >= wanted) return static_cast<float>(i) * kSubstep;
  }
  return -1;
}

TEST(Stillness, CountsWhatIsSlowAndBeginsAnewWithWhatIsFast) {
  Stillness stillness;
  EXPECT_NEAR(seconds_until_rest(stillness, 0.9f * kSpeed, 1, 200), 1, 2 * kSubstep);
  EXPECT_FALSE(stillness.moves());
  stillness.count(kSubstep, 10 * kSpeed, kSpeed);
  EXPECT_TRUE(stillness.moves());
  EXPECT_EQ(stillness.seconds(), 0);
  EXPECT_EQ(seconds_until_rest(stillness, 1.1f * kSpeed, 1, 1000), -1) << "slowly, but it goes somewhere";
}

/// A particle of a pressed body jumps: the body has five times its speed for one step, every half second.
TEST(Stillness, OneStepInManyDoesNotCount) {
  Stillness stillness;
  for (int i = 0; i < 240; ++i) stillness.count(kSubstep, i % 60 == 30 ? 5 * kSpeed : 0.1f * kSpeed, kSpeed);
  EXPECT_GT(stillness.seconds(), 1.5f);
}

/// After a speed that is smoothed over a quarter of a second: e^(-t / 0.25 s) of its square is left.
TEST(Stillness, ForgetsAsItSmooths) {
  Stillness stillness;
  for (int i = 0; i < 240; ++i) stillness.count(kSubstep, 10 * kSpeed, kSpeed);
  float seconds = 0;
  while (stillness.moves()) stillness.count(kSubstep, 0, kSpeed), seconds += kSubstep;
  EXPECT_NEAR(seconds, 0.25f * std::log(100.0f), 0.03f);
}

TEST(Stillness, WhatIsWokenMovesWhenItHasBegunTo) {
  Stillness stillness;
  for (int i = 0; i < 240; ++i) stillness.count(kSubstep, 0, kSpeed);
  stillness.begin();
  EXPECT_EQ(stillness.seconds(), 0);
  EXPECT_FALSE(stillness.moves());
  for (int i = 0; i < 20; ++i) stillness.count(kSubstep, 4 * kSpeed, kSpeed);
  EXPECT_TRUE(stillness.moves());
}

/// A bar that turns about its middle with w: the root of w^2 I / m.
TEST(SoftBody, MeanSpeedIsThatOfTheKineticEnergy) {
  SoftBody<3> body(make_soft_body_model(make_box({1, 0.2f, 0.2f}, 0.1f), {.cell_size = 0.1f}), {0, 0, 0});
  EXPECT_EQ(body.mean_speed(), 0);
  body.add_velocity({3, 4, 0});
  EXPECT_NEAR(body.mean_speed(), 5, 1e-5f);
  body.add_velocity({-3, -4, 0});
  body.add_angular_velocity({0, 2, 0});
  double inertia = 0;
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    const Eigen::Vector3d arm = (body.position(i) - body.centre_of_mass()).cast<double>();
    inertia += double{body.model().masses()[i]} * (arm.x() * arm.x() + arm.z() * arm.z());
  }
  EXPECT_NEAR(body.mean_speed(), 2 * std::sqrt(inertia / double{body.model().mass()}), 1e-4);
}

}  // namespace
}  // namespace softcell::ppu
