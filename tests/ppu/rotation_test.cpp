#include "ppu/matching/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>

#include "lattices.h"

namespace softcell::ppu {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::Random;

template <typename Real>
class Rotation : public ::testing::Test {
 public:
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  using Quaternion = Eigen::Quaternion<Real>;
  // Radians, for s2 + s3 >= 0.1 s1: the residual at which the iteration stops over (s2 + s3) / |A| >= 0.07.
  // It stops at a looser residual when it starts so far away that its iterations run out.
  static constexpr double kAngle = sizeof(Real) == 4 ? 3e-5 : 1e-11;
  static constexpr double kAngleFromAfar = sizeof(Real) == 4 ? 1.5e-4 : 1e-11;
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Rotation, Reals);

/// U diag(1, 1, det(U V^T)) V^T.
Matrix3d reference(const Matrix3d& a) {
  const Eigen::JacobiSVD<Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

double angle_between(const Matrix3d& a, const Matrix3d& b) {
  return 2 * std::asin(std::min(1.0, (a - b).norm() / std::sqrt(8.0)));  // |A - B| = sqrt(8) sin(angle / 2)
}

void expect_proper(const Matrix3d& r) {
  EXPECT_LT((r.transpose() * r - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_GT(r.determinant(), 0);
}

/// A matrix with these signed singular values, turned at random.
Matrix3d with_values(Random& random, const Vector3d& values) {
  const Matrix3d u = random.rotation().toRotationMatrix(), v = random.rotation().toRotationMatrix();
  return u * values.asDiagonal() * v.transpose();
}

/// Singular values of every kind that leaves one answer.
Vector3d determined_values(Random& random, int kind) {
  const double s1 = 1, s2 = 0.3 + 0.7 * std::abs(random.next());
  const double limit = s2 - 0.1;  // keeps s2 + s3 >= 0.1
  if (kind % 3 == 0) return {s1, s2, s2 * std::abs(random.next())};
  if (kind % 3 == 1) return {s1, s2, 0};
  return {s1, s2, -limit * std::abs(random.next())};
}

TYPED_TEST(Rotation, FindsTheOptimumFromAnywhere) {
  using Real = TypeParam;
  for (int seed = 0; seed < 6000; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const Matrix3d a = with_values(random, determined_values(random, seed));
    auto q = random.rotation().cast<Real>();
    const Matrix3d r = update_rotation<Real>(a.cast<Real>(), q).template cast<double>();
    expect_proper(r);
    EXPECT_LT(angle_between(r, reference(a)), TestFixture::kAngleFromAfar) << "seed " << seed;
    EXPECT_NEAR(static_cast<double>(q.norm()), 1.0, 1e-6);
    EXPECT_LT(angle_between(r, q.template cast<double>().toRotationMatrix()), 1e-5);
  }
}

TYPED_TEST(Rotation, FindsTheOptimumFromTheLastStep) {
  using Real = TypeParam;
  for (int seed = 0; seed < 6000; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 10000);
    const Matrix3d a = with_values(random, determined_values(random, seed));
    const Matrix3d optimum = reference(a);
    const AngleAxisd turned(0.35 * random.next(), random.vector().normalized());
    auto q = Quaterniond(Matrix3d(optimum * turned.toRotationMatrix())).cast<Real>();
    const Matrix3d r = update_rotation<Real>(a.cast<Real>(), q).template cast<double>();
    EXPECT_LT(angle_between(r, optimum), TestFixture::kAngle) << "seed " << seed;
  }
}

TYPED_TEST(Rotation, ColdStartAgreesWithWarmStart) {
  using Real = TypeParam;
  for (int seed = 0; seed < 1000; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 70000);
    const Matrix3d a = with_values(random, determined_values(random, seed));
    auto q = random.rotation().cast<Real>();
    const Matrix3d r = find_rotation<Real>(a.cast<Real>(), q).template cast<double>();
    EXPECT_LT(angle_between(r, reference(a)), TestFixture::kAngle) << "seed " << seed;
  }
}

TYPED_TEST(Rotation, LeavesTheSaddleHalfATurnAway) {
  using Real = TypeParam;
  for (int axis = 0; axis < 3; ++axis) {
    for (const Vector3d& values : {Vector3d(1, 0.8, 0.5), Vector3d(1, 0.8, 0), Vector3d(1, 1, 1)}) {
      const Matrix3d a = values.asDiagonal();
      typename TestFixture::Quaternion q(AngleAxisd(3.14159265358979, Vector3d::Unit(axis)).cast<Real>());
      const Matrix3d r = update_rotation<Real>(a.cast<Real>(), q).template cast<double>();
      EXPECT_LT(angle_between(r, Matrix3d::Identity()), TestFixture::kAngle) << "axis " << axis;
    }
  }
}

TYPED_TEST(Rotation, OfALineFollowsItsSwingAndKeepsItsTwist) {
  using Real = TypeParam;
  for (int seed = 0; seed < 200; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 90000);
    const Vector3d at_rest = random.vector().normalized();
    Vector3d along = random.vector().normalized();
    auto q = random.rotation().cast<Real>();
    Matrix3d before;
    for (int step = 0; step < 20; ++step) {
      const Matrix3d a = along * at_rest.transpose();
      const Matrix3d r = update_rotation<Real>(a.cast<Real>(), q).template cast<double>();
      expect_proper(r);
      EXPECT_LT((r * at_rest - along).norm(), 2e-5) << "seed " << seed << " step " << step;
      if (step > 0) {
        const AngleAxisd turned(Matrix3d(r * before.transpose()));
        EXPECT_LT(std::abs(turned.axis().dot(along)) * turned.angle(), 0.01) << "twisted, seed " << seed;
      }
      before = r;
      along = (along + 0.1 * random.vector()).normalized();
    }
  }
}

TYPED_TEST(Rotation, OfALineTurnedFarKeepsAsMuchAsItCan) {
  using Real = TypeParam;
  // From x to y in one go: a quarter turn about z and no twist.
  Matrix3d a = Vector3d::UnitY() * Vector3d::UnitX().transpose();
  auto q = TestFixture::Quaternion::Identity();
  const Matrix3d r = find_rotation<Real>(a.cast<Real>(), q).template cast<double>();
  EXPECT_LT(angle_between(r, AngleAxisd(std::acos(0.0), Vector3d::UnitZ()).toRotationMatrix()), 1e-3);
}

TYPED_TEST(Rotation, OfAPointStays) {
  using Real = TypeParam;
  Random random(1);
  const auto before = random.rotation().cast<Real>();
  for (const double scale : {0.0, 1e-20, 1e-9}) {
    auto q = before;
    const typename TestFixture::Matrix a = (scale * Matrix3d::Ones()).cast<Real>();
    expect_proper(update_rotation<Real>(a, q, Real(1e-8)).template cast<double>());
    EXPECT_EQ(q.coeffs(), before.coeffs());
    find_rotation<Real>(a, q, Real(1e-8));
    EXPECT_EQ(q.coeffs(), before.coeffs());
  }
}

TYPED_TEST(Rotation, DoesNotDependOnScale) {
  using Real = TypeParam;
  for (int seed = 0; seed < 600; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 110000);
    const Matrix3d a = with_values(random, determined_values(random, seed));
    for (const double scale : {1e15, 1e-15}) {
      auto q = random.rotation().cast<Real>();
      const Matrix3d r = update_rotation<Real>((scale * a).cast<Real>(), q).template cast<double>();
      expect_proper(r);
      EXPECT_LT(angle_between(r, reference(a)), TestFixture::kAngleFromAfar)
          << "seed " << seed << " scale " << scale;
    }
  }
}

TYPED_TEST(Rotation, IsProperForMatricesThatLeaveItOpen) {
  using Real = TypeParam;
  for (const Vector3d& values : {Vector3d(1, 1, -1), Vector3d(1, 0.5, -0.5), Vector3d(1, 0, 0),
                                 Vector3d(1, 1e-7, -1e-7), Vector3d(1, 1e-3, -1e-3), Vector3d(-1, -1, -1)}) {
    for (int seed = 0; seed < 300; ++seed) {
      Random random(static_cast<std::uint64_t>(seed) + 130000);
      const Matrix3d a = with_values(random, values);
      auto q = random.rotation().cast<Real>();
      const Matrix3d r = update_rotation<Real>(a.cast<Real>(), q).template cast<double>();
      expect_proper(r);
      // Not unique, but as good as the best.
      const double best = (reference(a).transpose() * a).trace();
      EXPECT_GT((r.transpose() * a).trace(), best - 2e-3)
          << "values " << values.transpose() << " seed " << seed;
    }
  }
}

TYPED_TEST(Rotation, IsContinuousThroughFlatAndInvertedShapes) {
  using Real = TypeParam;
  for (int seed = 0; seed < 50; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 150000);
    const Matrix3d u = random.rotation().toRotationMatrix(), v = random.rotation().toRotationMatrix();
    const Vector3d axis = random.vector().normalized();
    auto q = Quaterniond(u * v.transpose()).cast<Real>();
    Matrix3d before = u * v.transpose();
    constexpr int kSteps = 200;
    for (int step = 0; step <= kSteps; ++step) {
      const double t = static_cast<double>(step) / kSteps;
      const Matrix3d turned = AngleAxisd(2 * t, axis).toRotationMatrix() * u;  // 0.01 rad a step
      const Matrix3d a = turned * Vector3d(1, 0.8, 0.9 - 1.55 * t).asDiagonal() * v.transpose();
      const Matrix3d r = update_rotation<Real>(a.cast<Real>(), q).template cast<double>();
      EXPECT_LT(angle_between(r, before), 0.0101) << "seed " << seed << " step " << step;
      EXPECT_LT(angle_between(r, turned * v.transpose()), TestFixture::kAngle)
          << "seed " << seed << " step " << step;
      before = r;
    }
  }
}

}  // namespace
}  // namespace softcell::ppu
