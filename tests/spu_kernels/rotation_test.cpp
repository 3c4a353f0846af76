// The kernels' rotation, four at a time and in the SPU's arithmetic, against the singular value
// decomposition.
//
// SOFTCELL_FUZZ_ROTATIONS=10000000 makes the fuzz test as long as it is when it is run by hand.

#include "rotation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "spu_kernels/intrinsics_support.h"
#include "support/slow_build.h"

namespace softcell::spu {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Four matrices and quaternions as the test sees them.
struct Batch {
  Batch() { r.fill(Matrix3d::Zero()); }
  std::array<Matrix3d, 4> a, r;
  std::array<Quaterniond, 4> q;
  std::array<double, 4> residual{};
};

vec_float4 gather(const std::array<double, 4>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
          static_cast<float>(v[3])};
}

template <class Get>
vec_float4 lanes_of(const Get& get) {
  return gather({get(0), get(1), get(2), get(3)});
}

/// Runs with the SPU's arithmetic, and only the kernel's part.
template <class Find>
void run(Batch& batch, const Find& find) {
  const auto element = [&](int i, int j) {
    return lanes_of([&](std::size_t lane) { return batch.a[lane](i, j); });
  };
  const Matrix3x4 a = {{element(0, 0), element(0, 1), element(0, 2)},
                       {element(1, 0), element(1, 1), element(1, 2)},
                       {element(2, 0), element(2, 1), element(2, 2)}};
  Quaternion4 q = {lanes_of([&](std::size_t lane) { return batch.q[lane].x(); }),
                   lanes_of([&](std::size_t lane) { return batch.q[lane].y(); }),
                   lanes_of([&](std::size_t lane) { return batch.q[lane].z(); }),
                   lanes_of([&](std::size_t lane) { return batch.q[lane].w(); })};
  const unsigned int host = _mm_getcsr();
  _mm_setcsr(test::kSpuArithmetic);
  const Rotation4 found = find(a, q);
  _mm_setcsr(host);
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const auto of = [&](vec_float4 v) { return static_cast<double>(spu_extract(v, static_cast<int>(lane))); };
    const Matrix3x4& m = found.matrix;
    batch.r[lane] << of(m.x.x), of(m.x.y), of(m.x.z), of(m.y.x), of(m.y.y), of(m.y.z), of(m.z.x), of(m.z.y),
        of(m.z.z);
    batch.q[lane] = Quaterniond(of(q.w), of(q.x), of(q.y), of(q.z));
    batch.residual[lane] = std::sqrt(of(found.residual_square));
  }
}

RotationNoise noise_below(float floor) { return {spu_splats(1.0f), spu_splats(floor)}; }

void update(Batch& batch, RotationEffort effort, float floor = 0) {
  run(batch, [&](const Matrix3x4& a, Quaternion4& q) {
    const RotationProblem problem = {normalised(a, noise_below(floor)), {}};
    vec_uint4 indefinite;
    improve_rotations(&problem, &q, &indefinite, 1, effort);
    return rotation_of(problem, q, indefinite);
  });
}

/// U diag(1, 1, det(U V^T)) V^T.
Matrix3d reference(const Matrix3d& a) {
  const Eigen::JacobiSVD<Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

double angle_between(const Matrix3d& a, const Matrix3d& b) {
  return 2 * std::asin(std::min(1.0, (a - b).norm() / std::sqrt(8.0)));
}

bool proper(const Matrix3d& r) {
  return (r.transpose() * r - Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 && r.determinant() > 0;
}

class Source {
 public:
  explicit Source(std::uint64_t seed) : random_(seed) {}
  double next() { return uniform_(random_); }  ///< -1..1
  std::uint64_t bits() { return random_(); }
  Vector3d vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }
  Quaterniond rotation() {
    const double w = next(), x = next(), y = next(), z = next();
    return Quaterniond(w, x, y, z).normalized();
  }
  Matrix3d with_values(const Vector3d& values) {
    const Matrix3d u = rotation().toRotationMatrix(), v = rotation().toRotationMatrix();
    return u * values.asDiagonal() * v.transpose();
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

/// Any rank, and what lies between the ranks.
Matrix3d any_matrix(Source& source) {
  const auto magnitude = [&] { return std::exp2(-12 + 12 * source.next()); };
  const std::uint64_t choice = source.bits();
  switch (choice % 10) {
    case 0:
      return Matrix3d::NullaryExpr([&] { return source.next(); });
    case 1:
      return source.with_values({1, std::abs(source.next()), source.next()});
    case 2:
      return source.with_values({1, std::abs(source.next()), 0});
    case 3:
      return source.vector() * source.vector().transpose();
    case 4:
      return source.with_values({1, magnitude(), magnitude()});
    case 5:
      return source.with_values({1, 1, -1});
    case 6:
      return source.with_values({1, 0.5, -0.5});
    case 7: {  // lattice-aligned: exact zeros
      Matrix3d a = Matrix3d::Zero();
      for (int i = 0; i < 9; ++i)
        if ((choice >> (8 + i) & 1) != 0) a(i / 3, i % 3) = (choice >> (20 + i) & 1) != 0 ? 1 : -1;
      return a;
    }
    case 8:
      return -Matrix3d::Identity() + 1e-3 * Matrix3d::NullaryExpr([&] { return source.next(); });
    default:
      return Matrix3d::Zero();
  }
}

double scale_of(Source& source) { return std::pow(10.0, 15 * source.next()); }

std::size_t fuzz_count() {
  const char* const asked = std::getenv("SOFTCELL_FUZZ_ROTATIONS");
  if (asked != nullptr) return std::stoul(asked);
  return kSlowBuild ? 40'000 : 400'000;
}

TEST(KernelRotation, IsProperAndBestForEveryMatrix) {
  Source source(4);
  const std::size_t count = fuzz_count();
  std::size_t improper = 0, worse = 0;
  double worst = 0;
  for (std::size_t done = 0; done < count; done += 4) {
    Batch batch;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      batch.a[lane] = any_matrix(source);
      batch.q[lane] = source.rotation();
    }
    Batch scaled = batch;
    for (Matrix3d& a : scaled.a) a *= scale_of(source);
    update(scaled, done % 8 == 0 ? kTwoIterations : kAdaptive);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if (!proper(scaled.r[lane]) || std::abs(scaled.q[lane].norm() - 1) > 1e-5) {
        if (++improper < 5) ADD_FAILURE() << "improper for\n" << batch.a[lane] << "\n" << scaled.r[lane];
      }
    }
    if (done % 64 != 0) continue;  // the decomposition takes longer than all the rest
    const Matrix3d& a = batch.a[0];
    const double norm = a.cwiseAbs().sum();
    if (norm == 0) continue;
    const double shortfall =
        ((reference(a).transpose() * a).trace() - (scaled.r[0].transpose() * a).trace()) / norm;
    worst = std::max(worst, shortfall);
    if (shortfall > 2e-3 && ++worse < 5) ADD_FAILURE() << "worse by " << shortfall << " for\n" << a;
  }
  EXPECT_EQ(improper, 0u);
  EXPECT_EQ(worse, 0u);
  RecordProperty("matrices", static_cast<int>(count));
  RecordProperty("worst_shortfall", std::to_string(worst));
}

/// Singular values of every kind that leaves one answer: s2 + s3 >= 0.1.
Vector3d determined_values(Source& source, int kind) {
  const double s2 = 0.3 + 0.7 * std::abs(source.next());
  if (kind % 3 == 0) return {1, s2, s2 * std::abs(source.next())};
  if (kind % 3 == 1) return {1, s2, 0};
  return {1, s2, (0.1 - s2) * std::abs(source.next())};
}

TEST(KernelRotation, FindsTheOptimumFromTheLastStep) {
  Source source(5);
  for (int seed = 0; seed < 6000; ++seed) {
    Batch batch;
    std::array<Matrix3d, 4> optimum;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      batch.a[lane] = source.with_values(determined_values(source, seed));
      optimum[lane] = reference(batch.a[lane]);
      const double angle = 0.35 * source.next();
      const AngleAxisd turned(angle, source.vector().normalized());
      batch.q[lane] = Quaterniond(Matrix3d(optimum[lane] * turned.toRotationMatrix()));
    }
    update(batch, kAdaptive);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      ASSERT_LT(angle_between(batch.r[lane], optimum[lane]), 1e-4) << "seed " << seed;
      ASSERT_LT(batch.residual[lane], 3e-6) << "seed " << seed;
      ASSERT_LT(angle_between(batch.r[lane], batch.q[lane].normalized().toRotationMatrix()), 2e-6);
    }
  }
}

TEST(KernelRotation, TwoIterationsFindASmallTurn) {
  Source source(6);
  for (int seed = 0; seed < 3000; ++seed) {
    Batch batch;
    std::array<Matrix3d, 4> optimum;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      batch.a[lane] =
          source.with_values({1, 0.7 + 0.3 * std::abs(source.next()), 0.5 * std::abs(source.next())});
      optimum[lane] = reference(batch.a[lane]);
      const AngleAxisd turned(0.05, source.vector().normalized());
      batch.q[lane] = Quaterniond(Matrix3d(optimum[lane] * turned.toRotationMatrix()));
    }
    update(batch, kTwoIterations);
    for (std::size_t lane = 0; lane < 4; ++lane)
      ASSERT_LT(angle_between(batch.r[lane], optimum[lane]), 3e-6) << "seed " << seed;
  }
}

TEST(KernelRotation, ColdStartFindsTheOptimumFromAnywhere) {
  Source source(7);
  for (int seed = 0; seed < 2000; ++seed) {
    Batch batch;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      batch.a[lane] = source.with_values(determined_values(source, seed));
      batch.q[lane] = source.rotation();
    }
    run(batch, [](const Matrix3x4& a, Quaternion4& q) {
      return find_rotation({normalised(a, noise_below(0)), {}}, q);
    });
    for (std::size_t lane = 0; lane < 4; ++lane)
      ASSERT_LT(angle_between(batch.r[lane], reference(batch.a[lane])), 1e-4) << "seed " << seed;
  }
}

TEST(KernelRotation, LeavesTheSaddlesHalfATurnAway) {
  for (const Vector3d& values : {Vector3d(1, 0.8, 0.5), Vector3d(1, 0.8, 0), Vector3d(1, 1, 1)}) {
    Batch batch;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      batch.a[lane] = values.asDiagonal();
      const Vector3d axis = lane < 3 ? Vector3d::Unit(static_cast<int>(lane)) : Vector3d(0.6, 0.8, 0);
      batch.q[lane] = Quaterniond(AngleAxisd(3.14159265358979, axis));
    }
    for (const RotationEffort effort : {kTwoIterations, kAdaptive}) {
      Batch copy = batch;
      update(copy, effort);
      for (std::size_t lane = 0; lane < 4; ++lane)
        EXPECT_LT(angle_between(copy.r[lane], Matrix3d::Identity()), 3e-5) << "lane " << lane;
    }
  }
}

TEST(KernelRotation, OfALineFollowsItsSwingAndKeepsItsTwist) {
  Source source(8);
  for (int seed = 0; seed < 200; ++seed) {
    std::array<Vector3d, 4> at_rest, along;
    Batch batch;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      at_rest[lane] = source.vector().normalized();
      along[lane] = source.vector().normalized();
      batch.q[lane] = source.rotation();
    }
    std::array<Matrix3d, 4> before;
    for (int step = 0; step < 20; ++step) {
      for (std::size_t lane = 0; lane < 4; ++lane) batch.a[lane] = along[lane] * at_rest[lane].transpose();
      update(batch, kAdaptive);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        ASSERT_TRUE(proper(batch.r[lane]));
        ASSERT_LT((batch.r[lane] * at_rest[lane] - along[lane]).norm(), 5e-5) << seed << " step " << step;
        if (step > 0) {
          const AngleAxisd turned(Matrix3d(batch.r[lane] * before[lane].transpose()));
          ASSERT_LT(std::abs(turned.axis().dot(along[lane])) * turned.angle(), 0.01)
              << "twisted, seed " << seed << " step " << step;
        }
        before[lane] = batch.r[lane];
        along[lane] = (along[lane] + 0.1 * source.vector()).normalized();
      }
    }
  }
}

TEST(KernelRotation, OfAPointStays) {
  Source source(9);
  for (const double scale : {0.0, 1e-30, 1e-9, 5e-9}) {
    Batch batch;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      batch.a[lane] = scale * Matrix3d::Ones() / 9;
      batch.q[lane] = source.rotation();
    }
    const Batch before = batch;
    for (const RotationEffort effort : {kTwoIterations, kAdaptive}) {
      Batch copy = before;
      update(copy, effort, 1e-8f);
      for (std::size_t lane = 0; lane < 4; ++lane)
        EXPECT_LT(angle_between(copy.r[lane], before.q[lane].toRotationMatrix()), 2e-6) << scale;
    }
  }
}

TEST(KernelRotation, IsContinuousThroughFlatAndInvertedShapes) {
  Source source(10);
  for (int seed = 0; seed < 100; ++seed) {
    Batch batch;
    std::array<Matrix3d, 4> u, v, before;
    std::array<Vector3d, 4> axis;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      u[lane] = source.rotation().toRotationMatrix();
      v[lane] = source.rotation().toRotationMatrix();
      axis[lane] = source.vector().normalized();
      before[lane] = u[lane] * v[lane].transpose();
      batch.q[lane] = Quaterniond(before[lane]);
    }
    const RotationEffort effort = seed % 2 == 0 ? kTwoIterations : kAdaptive;
    constexpr int kSteps = 200;
    for (int step = 0; step <= kSteps; ++step) {
      const double t = static_cast<double>(step) / kSteps;
      std::array<Matrix3d, 4> expected;
      for (std::size_t lane = 0; lane < 4; ++lane) {
        // 0.01 rad a step.
        const Matrix3d turned = AngleAxisd(2 * t, axis[lane]).toRotationMatrix() * u[lane];
        batch.a[lane] = turned * Vector3d(1, 0.8, 0.9 - 1.55 * t).asDiagonal() * v[lane].transpose();
        expected[lane] = turned * v[lane].transpose();
      }
      update(batch, effort);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        ASSERT_LT(angle_between(batch.r[lane], before[lane]), 0.0102) << "seed " << seed << " step " << step;
        ASSERT_LT(angle_between(batch.r[lane], expected[lane]), 1e-4) << "seed " << seed << " step " << step;
        before[lane] = batch.r[lane];
      }
    }
  }
}

}  // namespace
}  // namespace softcell::spu
