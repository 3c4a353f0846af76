// The kernels' 3-vectors, four at a time, against the formulas.

#include "common/vector3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/reciprocal.h"

namespace softcell::spu {
namespace {

TEST(KernelVector3, ReciprocalSqrtsKeepTheirStatedErrors) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-120, 120);
  for (int i = 0; i < 200'000; ++i) {
    const float x = std::exp2(exponent(random));
    const double expected = 1 / std::sqrt(static_cast<double>(x));
    const float actual = spu_extract(reciprocal_sqrt(spu_splats(x)), i % 4);
    ASSERT_LT(std::fabs(static_cast<double>(actual) - expected), 5e-6 * expected) << x;
    const float rough = spu_extract(rough_reciprocal_sqrt(spu_splats(x)), i % 4);
    ASSERT_LT(std::fabs(static_cast<double>(rough) - expected), 3e-5 * expected) << x;
  }
}

TEST(KernelVector3, CrossAndDotFollowTheirFormulas) {
  const Vector3x4 a = {vec_float4(1, 2, 0, -1), vec_float4(0, 3, 1, 5), vec_float4(0, -1, 2, 4)};
  const Vector3x4 b = {vec_float4(0, 1, 1, 2), vec_float4(1, -2, 1, -3), vec_float4(0, 4, 1, 6)};
  const Vector3x4 c = cross(a, b);
  const float x[] = {0, 10, -1, 42}, y[] = {0, -9, 2, 14}, z[] = {1, -7, -1, -7}, d[] = {0, -8, 3, 7};
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_EQ(spu_extract(c.x, lane), x[lane]);
    EXPECT_EQ(spu_extract(c.y, lane), y[lane]);
    EXPECT_EQ(spu_extract(c.z, lane), z[lane]);
    EXPECT_EQ(spu_extract(dot(a, b), lane), d[lane]);
  }
}

}  // namespace
}  // namespace softcell::spu
