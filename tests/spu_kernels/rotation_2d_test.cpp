// Directions of regions in two dimensions, four at a time: the best rotation of any 2x2 matrix.

#include "rotation_2d.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "spu_kernels/intrinsics_support.h"

namespace softcell::spu {
namespace {

class Rotation2d : public test::SpuArithmetic {
 protected:
  static double at(vec_float4 v, int lane) { return double{spu_extract(v, lane)}; }

  /// The direction of one C and S, found in lane `lane` beside other lanes' trouble.
  static std::pair<double, double> direction(float c, float s, int lane, float floor = 0) {
    const vec_float4 cs = spu_insert(c, vec_float4(0, 3e38f, 1e-38f, -1), lane);
    const vec_float4 ss = spu_insert(s, vec_float4(0, 3e38f, -1e-38f, 0), lane);
    const Direction4 kept = {spu_splats(0.6f), spu_splats(-0.8f)};
    const Direction4 d = direction_of(cs, ss, {spu_splats(1.0f), spu_splats(floor)}, kept);
    return {at(d.cosine, lane), at(d.sine, lane)};
  }

  std::mt19937 random_{5};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

constexpr double kAngle = 5e-7;  // radians
constexpr double kLength = 4e-7;

TEST_F(Rotation2d, IsTheAngleOfEveryMatrixThatHasOne) {
  for (int i = 0; i < 1'000'000; ++i) {
    // U diag(s1, s2) V with s2 of any size and sign: of rank 2 and 1, mirrored too.
    const double scale = std::pow(10, 15 * uniform_(random_)), s1 = scale;
    const double s2 = i % 3 == 0 ? 0 : 0.99 * uniform_(random_) * scale;
    const double u = 4 * uniform_(random_), v = 4 * uniform_(random_);
    // C = A11 + A22 and S = A21 - A12 of that product.
    const auto c = static_cast<float>((s1 + s2) * std::cos(u + v));
    const auto s = static_cast<float>((s1 + s2) * std::sin(u + v));
    const auto [cosine, sine] = direction(c, s, i % 4);
    ASSERT_NEAR(std::hypot(cosine, sine), 1, kLength) << c << ' ' << s;
    const double expected = std::atan2(double{s}, double{c});
    ASSERT_NEAR(std::remainder(std::atan2(sine, cosine) - expected, 2 * 3.14159265358979), 0, kAngle)
        << c << ' ' << s;
  }
}

TEST_F(Rotation2d, WhatHasNoAngleKeepsTheLastOne) {
  for (int lane = 0; lane < 4; ++lane) {
    for (const auto& [c, s, floor] :
         {std::array{0.0f, 0.0f, 0.0f}, std::array{-0.0f, 0.0f, 1e-6f}, std::array{3e-7f, -7e-7f, 1e-6f},
          std::array{1e-38f, 0.0f, 0.0f}, std::array{1.7e38f, 1e38f, 0.0f}}) {
      const auto [cosine, sine] = direction(c, s, lane, floor);
      EXPECT_EQ(cosine, double{0.6f}) << c << ' ' << s;
      EXPECT_EQ(sine, double{-0.8f}) << c << ' ' << s;
    }
  }
}

TEST_F(Rotation2d, IsContinuousThroughFlatAndInvertedShapes) {
  // The x axis shrinks, is nothing and comes out on the other side, less far than y reaches.
  double before = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double x = 1 - 1.9 * i / 1000, shear = 0.3 * i / 1000;
    const auto [cosine, sine] = direction(static_cast<float>(x + 1), static_cast<float>(shear), i % 4);
    const double angle = std::atan2(sine, cosine);
    ASSERT_NEAR(angle, before, 0.02) << x;
    before = angle;
  }
  EXPECT_GT(before, 1);  // it has turned
}

TEST_F(Rotation2d, TurnsVectorsBothWays) {
  const Direction4 quarter = {spu_splats(0.0f), spu_splats(1.0f)};
  const Vector2x4 v = {vec_float4(1, 2, 3, 4), vec_float4(5, 6, 7, 8)};
  const Vector2x4 one = {spu_splats(1.0f), spu_splats(1.0f)};
  const Vector2x4 plus = add_turned(one, quarter, v), minus = subtract_turned(one, quarter, v);
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_EQ(at(plus.x, lane), 1 - (5 + lane));
    EXPECT_EQ(at(plus.y, lane), 1 + (1 + lane));
    EXPECT_EQ(at(minus.x, lane), 1 + (5 + lane));
    EXPECT_EQ(at(minus.y, lane), 1 - (1 + lane));
  }
}

}  // namespace
}  // namespace softcell::spu
