// The stages of the kernel match, one by one, each against its scalar twin.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "common/finite.h"
#include "common/matrix3.h"
#include "common/reciprocal.h"
#include "common/transpose.h"
#include "match/step.h"
#include "spu_kernels/intrinsics_support.h"

namespace softcell::spu {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::lanes;

class MatchStages : public test::SpuArithmetic {
 protected:
  float next() { return uniform_(random_); }
  vec_float4 next4() {
    const float a = next(), b = next(), c = next(), d = next();
    return {a, b, c, d};
  }
  Vector3x4 next_vector() {
    const vec_float4 x = next4(), y = next4(), z = next4();
    return {x, y, z};
  }

 private:
  std::mt19937 random_{11};
  std::uniform_real_distribution<float> uniform_{-1, 1};
};

double at(vec_float4 v, int lane) { return double{spu_extract(v, lane)}; }
Vector3d at(const Vector3x4& v, int lane) { return {at(v.x, lane), at(v.y, lane), at(v.z, lane)}; }

TEST_F(MatchStages, TransposeAndSumsOfRows) {
  const Rows4 m = {next4(), next4(), next4(), next4()};
  const vec_float4 rows[] = {m.a, m.b, m.c, m.d};
  const Rows4 t = transpose(m);
  const vec_float4 columns[] = {t.a, t.b, t.c, t.d};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) EXPECT_EQ(at(columns[j], i), at(rows[i], j));
    EXPECT_NEAR(at(sums_of_rows(m), i), at(rows[i], 0) + at(rows[i], 1) + at(rows[i], 2) + at(rows[i], 3),
                1e-6);
    EXPECT_NEAR(at(sum_of_lanes(m.a), i), at(m.a, 0) + at(m.a, 1) + at(m.a, 2) + at(m.a, 3), 1e-6);
  }
}

TEST_F(MatchStages, ReciprocalsKeepTheirStatedErrors) {
  for (int i = 0; i < 100'000; ++i) {
    const float x = std::exp2(100 * next());
    EXPECT_NEAR(at(reciprocal(spu_splats(x)), 0) * double{x}, 1, 4e-7) << x;
    EXPECT_NEAR(at(rough_reciprocal(spu_splats(x)), 0) * double{x}, 1, 3e-4) << x;
  }
}

TEST_F(MatchStages, QuaternionsTurnAndBecomeMatrices) {
  for (int i = 0; i < 1000; ++i) {
    const Quaternion4 q = turn({next4(), next4(), next4(), next4()}, {next4(), next4(), next4()});
    const Vector3x4 half = scale(next_vector(), spu_splats(0.5f));
    const Quaternion4 turned = turn(q, half);
    const Matrix3x4 r = matrix_of(turned);
    for (int lane = 0; lane < 4; ++lane) {
      const Eigen::Quaterniond before(at(q.w, lane), at(q.x, lane), at(q.y, lane), at(q.z, lane));
      const Vector3d by = at(half, lane);
      const Matrix3d expected =
          (before * Eigen::Quaterniond(1, by.x(), by.y(), by.z())).normalized().toRotationMatrix();
      Matrix3d actual;
      actual << at(r.x, lane).transpose(), at(r.y, lane).transpose(), at(r.z, lane).transpose();
      EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 2e-6);
      EXPECT_LT((actual.transpose() * actual - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

TEST_F(MatchStages, LocaliseSubtractsAPointOfTheGridAndComesBack) {
  constexpr uint32_t kCount = 7;  // that are localised, of those whose mean is the origin
  Vectors4 groups[kMatchSamples / 4];
  vec_float4* const x = particle_quadwords(groups);
  std::array<std::array<float, 4>, kMatchSamples> before;
  for (uint32_t i = 0; i < kMatchSamples; ++i) {
    before[i] = {100 + next(), -50 + next(), next(), 0};
    x[i] = test::vector_of<vec_float4>(before[i]);
  }
  const vec_float4 origin = origin_of(x, 0.0625f);
  for (int d = 0; d < 3; ++d) {
    double mean = 0;
    for (const auto& p : before) mean += double{p[static_cast<std::size_t>(d)]} / kMatchSamples;
    EXPECT_NEAR(at(origin, d), mean, 0.07);
    EXPECT_EQ(std::fmod(at(origin, d), 0.0625), 0);
  }
  to_components(groups, kCount, origin);
  for (uint32_t i = 0; i < kCount; ++i)
    EXPECT_EQ(at(groups[i / 4].v.x, static_cast<int>(i % 4)), double{before[i][0]} - at(origin, 0));
  EXPECT_EQ(at(groups[1].v, 3), Vector3d::Zero());  // padding
  to_particles(groups, 2);
  for (uint32_t i = 0; i < kCount; ++i) {
    EXPECT_EQ(at(x[i], 1) + at(origin, 1), double{before[i][1]});
    EXPECT_EQ(at(x[i], 3), 0);
  }
}

TEST_F(MatchStages, WhatIsNoNumberIsFound) {
  std::array<vec_float4, 5> v;
  v.fill(spu_splats(-3e38f));
  EXPECT_TRUE(all_finite(v.data(), 5));
  for (const float bad : {INFINITY, -INFINITY, NAN}) {
    for (int lane = 0; lane < 4; ++lane) {
      v[3] = spu_insert(bad, spu_splats(1.0f), lane);
      EXPECT_FALSE(all_finite(v.data(), 5));
      EXPECT_TRUE(all_finite(v.data(), 3));
    }
  }
}

TEST_F(MatchStages, SumSlotsFollowsItsList) {
  std::vector<Slot> in(7), out(7);
  for (Slot& slot : in) slot = {{next4(), next4(), next4()}};
  const auto o = [](int slot) { return static_cast<uint16_t>(slot * sizeof(Slot) / kSumOffsetUnit); };
  const uint16_t list[] = {3,
                           1,
                           1,
                           1,  // a chain of
                           o(1),
                           o(2),
                           o(3),  // slots 1 + 2 + 3,
                           o(4),  // plus 4,
                           o(5),
                           o(1),  // plus 5 minus 1,
                           o(2),  // minus 2;
                           1,
                           0,
                           0,
                           0,     // another of
                           o(6),  // slot 6 alone;
                           kSumRun + 1,
                           o(1),
                           o(2),
                           o(3),  // a run: slot 1, plus 2 minus 3
                           0};
  sum_slots<3>(list, in.data(), out.data());
  for (std::size_t k = 0; k < 3; ++k) {
    for (int lane = 0; lane < 4; ++lane) {
      const auto term = [&](std::size_t slot) { return at(in[slot].row[k], lane); };
      EXPECT_NEAR(at(out[1].row[k], lane), term(1) + term(2) + term(3), 1e-6);
      EXPECT_NEAR(at(out[2].row[k], lane), term(1) + term(2) + term(3) + term(4), 1e-6);
      EXPECT_NEAR(at(out[3].row[k], lane), term(2) + term(3) + term(4) + term(5), 1e-6);
      EXPECT_NEAR(at(out[4].row[k], lane), term(3) + term(4) + term(5), 1e-6);
      EXPECT_EQ(at(out[5].row[k], lane), term(6));
      EXPECT_NEAR(at(out[6].row[k], lane), term(1) + term(2) - term(3), 1e-6);
    }
  }
  std::vector<Slot> two_rows(7, Slot{{spu_splats(7.0f), spu_splats(7.0f), spu_splats(7.0f)}});
  sum_slots<2>(list, in.data(), two_rows.data());
  for (std::size_t slot = 1; slot <= 6; ++slot) {
    EXPECT_EQ(lanes(two_rows[slot].row[1]), lanes(out[slot].row[1]));
    EXPECT_EQ(at(two_rows[slot].row[2], 0), 7);  // left alone
  }
}

/// Four particles, each its own region: up, the region's motion and down again.
struct FourParticles {
  ParticleConstants constants;
  Vector3x4 rest, x;
};

TEST_F(MatchStages, MomentsMotionsAndGoals) {
  FourParticles p;
  p.rest = next_vector();
  p.x = next_vector();
  p.constants.mass = spu_splats(2.0f);
  p.constants.inverse_mass = spu_splats(0.5f);
  for (int lane = 0; lane < 4; ++lane) {
    const Vector3d x0 = at(p.rest, lane);
    p.constants.rest_moment[lane] = {static_cast<float>(2 * x0.x()), static_cast<float>(2 * x0.y()),
                                     static_cast<float>(2 * x0.z()), 2.0f};
    p.constants.region[lane] = static_cast<uint32_t>(lane + 1) * kMatchSlotBytes / kSumOffsetUnit;
  }
  std::array<Slot, 5> slots;
  match_moments(p.constants.rest_moment, p.x, &slots[1]);
  for (int lane = 0; lane < 4; ++lane) {
    const Vector3d x = at(p.x, lane), x0 = at(p.rest, lane);
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(at(slots[static_cast<std::size_t>(lane) + 1].row[k], j), 2 * x[k] * x0[j], 1e-6);
      EXPECT_NEAR(at(slots[static_cast<std::size_t>(lane) + 1].row[k], 3), 2 * x[k], 1e-6);
    }
  }

  // Of one particle each, so that A = 0 and what comes down moves the particle's rest position to where it
  // is.
  const RegionConstants regions = {p.rest, spu_splats(0.5f)};
  make_problem(regions, &slots[1], &slots[1], spu_splats(1e-6f));
  const RotationProblem problem = *problem_at(&slots[1]);
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_EQ(at(problem.a.x, lane), Vector3d::Zero());  // noise
    EXPECT_LT((at(problem.payload, lane) - 2 * at(p.x, lane)).norm(), 1e-6);
  }
  const Quaternion4 q = turn({next4(), next4(), next4(), next4()}, {next4(), next4(), next4()});
  const Matrix3x4 r = matrix_of(q);
  store_motions(regions, r, problem.payload, &slots[1]);
  const Vector3x4 goal =
      goals(p.constants.rest_moment, p.constants.inverse_mass, p.constants.region, slots.data());
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_LT((at(goal, lane) - at(p.x, lane)).norm(), 2e-6);
    EXPECT_NEAR(at(slots[static_cast<std::size_t>(lane) + 1].row[1], 2), at(r.y.z, lane), 0);
  }
}

TEST_F(MatchStages, AngularVelocityInvertsTheInertia) {
  for (int i = 0; i < 1000; ++i) {
    std::array<Matrix3d, 4> second;
    Symmetric3x4 c;
    const Vector3x4 l = next_vector(), a = next_vector(), b = next_vector(), d = next_vector();
    const auto element = [&](int row, int column) {
      std::array<float, 4> result;
      for (int lane = 0; lane < 4; ++lane) {
        const Vector3d pa = at(a, lane), pb = at(b, lane), pd = at(d, lane);
        const auto k = static_cast<std::size_t>(lane);
        second[k] = (pa * pa.transpose() + pb * pb.transpose() + pd * pd.transpose()).eval();
        result[k] = static_cast<float>(second[k](row, column));
      }
      return test::vector_of<vec_float4>(result);
    };
    c = {element(0, 0), element(1, 1), element(2, 2), element(0, 1), element(1, 2), element(2, 0)};
    const Vector3x4 omega = angular_velocity(c, l, spu_splats(1e-6f));
    for (int lane = 0; lane < 4; ++lane) {
      const Matrix3d& s = second[static_cast<std::size_t>(lane)];
      const Matrix3d inertia = s.trace() * Matrix3d::Identity() - s;
      EXPECT_LT((inertia * at(omega, lane) - at(l, lane)).norm(), 2e-4 * (1 + at(omega, lane).norm()));
    }
  }
}

TEST_F(MatchStages, AngularVelocityOfALineAndAPoint) {
  const vec_float4 one = spu_splats(1.0f), zero = spu_splats(0.0f);
  // Along x: turns about y and z, nothing about x.
  const Vector3x4 line =
      angular_velocity({one, zero, zero, zero, zero, zero}, {zero, one, one}, spu_splats(1e-6f));
  EXPECT_LT((at(line, 2) - Vector3d(0, 1, 1)).norm(), 1e-4);
  const Vector3x4 point =
      angular_velocity({zero, zero, zero, zero, zero, zero}, {one, one, one}, spu_splats(1e-6f));
  EXPECT_EQ(at(point, 1), Vector3d::Zero());
}

}  // namespace
}  // namespace softcell::spu
