// Lattice shape matching keeps what the equations promise, on lattices of every kind, in float and double.

#include "ppu/reference/shape_matching.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "lattices.h"
#include "particle_vectors.h"
#include "ppu/matching/regions.h"
#include "support/allocation_counter.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::largest_difference;
using test::Random;

constexpr int kLargestHalfWidth = 4;

/// One body in one precision: positions and velocities go in and out in double.
template <typename Real>
class Body {
 public:
  using Vector = Eigen::Matrix<Real, 3, 1>;

  Body(const Lattice<3>& lattice, int half_width, std::vector<float> masses = {},
       SumMethod method = SumMethod::kBarPlateCube)
      : masses_(masses.empty() ? particle_masses(lattice, 1000) : std::move(masses)),
        matcher_(std::make_shared<const MatchingPlan<Real, 3>>(lattice, half_width, masses_), method) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i)
      rest_.push_back(lattice.origin.cast<double>() +
                      static_cast<double>(lattice.spacing) * lattice.particles[i].cast<double>());
  }

  std::vector<Vector3d> goals(const std::vector<Vector3d>& x) {
    const std::vector<Vector> in = narrow(x);
    std::vector<Vector> out(in.size());
    matcher_.goals(in, out);
    return widen(out);
  }
  std::vector<Vector3d> step(const std::vector<Vector3d>& x, const std::vector<Vector3d>& v, double alpha,
                             double h, double damping) {
    const std::vector<Vector> in = narrow(x);
    std::vector<Vector> out = narrow(v);
    matcher_.step_velocities(in, out, static_cast<Real>(alpha), static_cast<Real>(h),
                             static_cast<Real>(damping));
    return widen(out);
  }

  const std::vector<Vector3d>& rest() const { return rest_; }
  double mass(std::size_t i) const { return static_cast<double>(masses_[i]); }
  double total_mass() const { return test::total_mass(masses_); }
  ShapeMatcher<Real, 3>& matcher() { return matcher_; }

  static std::vector<Vector> narrow(const std::vector<Vector3d>& x) {
    std::vector<Vector> result;
    for (const Vector3d& v : x) result.push_back(v.cast<Real>());
    return result;
  }
  /// Positions as the solver sees them, rounded.
  static std::vector<Vector3d> rounded(const std::vector<Vector3d>& x) { return widen(narrow(x)); }
  static std::vector<Vector3d> widen(const std::vector<Vector>& x) {
    std::vector<Vector3d> result;
    for (const Vector& v : x) result.push_back(v.template cast<double>());
    return result;
  }

 private:
  std::vector<float> masses_;
  std::vector<Vector3d> rest_;
  ShapeMatcher<Real, 3> matcher_;
};

std::vector<Vector3d> noise(std::size_t count, double size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vector3d> result(count);
  for (Vector3d& v : result) v = size * random.vector();
  return result;
}

std::vector<Vector3d> sum(std::vector<Vector3d> a, const std::vector<Vector3d>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

std::vector<Vector3d> moved(std::vector<Vector3d> x, const Matrix3d& r, const Vector3d& t) {
  for (Vector3d& v : x) v = r * v + t;
  return x;
}

std::vector<float> uneven_masses(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> masses(count);
  for (float& mass : masses) mass = static_cast<float>(1.1 + random.next());
  return masses;
}

template <typename Real>
class Matching : public ::testing::Test {
 public:
  static constexpr bool kFloat = sizeof(Real) == 4;
  static constexpr double kMomentum = kFloat ? 1e-5 : 1e-12;   // metres, or metres^2, per kilogram of body
  static constexpr double kRigid = kFloat ? 2e-6 : 1e-14 * 8;  // metres; bodies are about a metre long
  // Metres, where rotations come out of different sums.
  static constexpr double kGoals = kFloat ? 2e-5 : 1e-11;
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Matching, Reals);

TYPED_TEST(Matching, KeepsLinearAndAngularMomentum) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    using Real = TypeParam;
    Body<Real> body(lattice, w, uneven_masses(lattice.particles.size(), 7));
    const Matrix3d turned = Random(3).rotation().toRotationMatrix();
    const auto x = Body<Real>::rounded(
        sum(moved(body.rest(), turned, {0.3, -0.2, 0.1}), noise(body.rest().size(), 0.04, 4)));
    const auto g = body.goals(x);
    Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) {
      linear += body.mass(i) * (g[i] - x[i]);
      angular += body.mass(i) * x[i].cross(g[i] - x[i]);
    }
    EXPECT_LT(linear.norm() / body.total_mass(), TestFixture::kMomentum);
    EXPECT_LT(angular.norm() / body.total_mass(), TestFixture::kMomentum);
    EXPECT_GT(largest_difference(x, g), 1e-3);  // there was something to do
  });
}

TYPED_TEST(Matching, DampingKeepsMomentaAndAddsNoEnergy) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    using Real = TypeParam;
    Body<Real> body(lattice, w, uneven_masses(lattice.particles.size(), 8));
    const auto x = Body<Real>::rounded(sum(body.rest(), noise(body.rest().size(), 0.02, 5)));
    const auto v = Body<Real>::rounded(noise(body.rest().size(), 1, 6));
    for (const double k : {0.1, 1.0}) {
      const auto after = body.step(x, v, 0, 0.01, k);
      Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
      double energy = 0, energy_before = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        linear += body.mass(i) * (after[i] - v[i]);
        angular += body.mass(i) * x[i].cross(after[i] - v[i]);
        energy += body.mass(i) * after[i].squaredNorm();
        energy_before += body.mass(i) * v[i].squaredNorm();
      }
      EXPECT_LT(linear.norm() / body.total_mass(), TestFixture::kMomentum);
      EXPECT_LT(angular.norm() / body.total_mass(), TestFixture::kMomentum);
      EXPECT_LT(energy, energy_before);
    }
    EXPECT_EQ(largest_difference(body.step(x, v, 0, 0.01, 0), v), 0);  // k = 0 is the identity
  });
}

TYPED_TEST(Matching, LeavesRigidMotionAlone) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    using Real = TypeParam;
    Body<Real> body(lattice, w);
    const Matrix3d turned = Random(9).rotation().toRotationMatrix();
    const auto x = moved(body.rest(), turned, {0.2, 0.4, -0.3});
    EXPECT_LT(largest_difference(body.goals(x), x), TestFixture::kRigid);
    const Vector3d velocity(0.3, -0.5, 0.2), omega(1, 2, -0.5);
    std::vector<Vector3d> v;
    for (const Vector3d& position : x) v.push_back(velocity + omega.cross(position));
    EXPECT_LT(largest_difference(body.step(x, v, 0, 0.01, 1), v), TestFixture::kFloat ? 2e-5 : 1e-12);
    // At rest nothing moves at all, in any number of steps.
    auto still = body.step(body.rest(), noise(x.size(), 0, 0), 1, 1.0 / 60, 0.1);
    for (const Vector3d& at_rest : still) EXPECT_LT(at_rest.norm() / 60, TestFixture::kRigid);
  });
}

TYPED_TEST(Matching, TurnsWithTheBody) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    using Real = TypeParam;
    const Matrix3d turned = Random(10).rotation().toRotationMatrix();
    const Vector3d shift(0.7, -0.4, 0.9);
    Body<Real> body(lattice, w), other(lattice, w);
    const auto x = sum(body.rest(), noise(body.rest().size(), 0.03, 11));
    const auto v = noise(body.rest().size(), 0.5, 12);
    EXPECT_LT(largest_difference(other.goals(moved(x, turned, shift)), moved(body.goals(x), turned, shift)),
              TestFixture::kGoals);
    const Vector3d none = Vector3d::Zero();
    EXPECT_LT(largest_difference(other.step(moved(x, turned, shift), moved(v, turned, none), 0, 0.01, 0.5),
                                 moved(body.step(x, v, 0, 0.01, 0.5), turned, none)),
              TestFixture::kGoals * 20);
  });
}

/// The particle of each lattice that lies where `map` sends the particle of the other.
std::vector<std::size_t> partners(const Lattice<3>& from, const Lattice<3>& to,
                                  const std::function<Eigen::Vector3i(const Eigen::Vector3i&)>& map) {
  std::vector<std::size_t> result;
  for (const Eigen::Vector3i& particle : from.particles) {
    const auto found = std::find(to.particles.begin(), to.particles.end(), map(particle));
    result.push_back(static_cast<std::size_t>(found - to.particles.begin()));
  }
  return result;
}

std::vector<Vector3d> carried(const std::vector<Vector3d>& x, const std::vector<std::size_t>& to,
                              const Matrix3d& map) {
  std::vector<Vector3d> result(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) result[to[i]] = map * x[i];
  return result;
}

/// Maps lattice and positions together and expects the goals to follow.
template <typename Real>
void expect_goals_follow(const Matrix3d& map, double tolerance) {
  const Eigen::Matrix3i grid_map = map.cast<int>();
  for (const auto& [name, cells] : test::all_cells()) {
    const Lattice<3> lattice = lattice_from_cells(cells, 0.1f, {0, 0, 0});
    std::vector<Eigen::Vector3i> mapped_cells;  // the low corner of a mapped cell is its centre less one half
    for (const Eigen::Vector3i& cell : cells)
      mapped_cells.push_back((grid_map * (2 * cell + Eigen::Vector3i::Ones()) - Eigen::Vector3i::Ones()) / 2);
    const Lattice<3> mapped = lattice_from_cells(mapped_cells, 0.1f, {0, 0, 0});
    const auto to =
        partners(lattice, mapped, [&](const Eigen::Vector3i& p) { return Eigen::Vector3i(grid_map * p); });
    for (int w = 1; w <= kLargestHalfWidth; ++w) {
      Body<Real> body(lattice, w), other(mapped, w);
      const auto x = sum(body.rest(), noise(body.rest().size(), 0.03, 13));
      EXPECT_LT(largest_difference(other.goals(carried(x, to, map)), carried(body.goals(x), to, map)),
                tolerance)
          << name << " w " << w;
    }
  }
}

TYPED_TEST(Matching, MirrorsWithTheBody) {
  expect_goals_follow<TypeParam>(Vector3d(-1, 1, 1).asDiagonal(), TestFixture::kGoals);
}

TYPED_TEST(Matching, DoesNotDependOnTheNumberingOfParticles) {
  Matrix3d turn_axes;  // x -> y -> z -> x: bars become plates
  turn_axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  expect_goals_follow<TypeParam>(turn_axes, TestFixture::kGoals);
}

TYPED_TEST(Matching, DoesNotDependOnTheScaleOfTheMasses) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    std::vector<float> masses = uneven_masses(lattice.particles.size(), 14), heavy = masses;
    for (float& mass : heavy) mass *= 1024;  // exact
    Body<TypeParam> body(lattice, w, masses), other(lattice, w, heavy);
    const auto x = sum(body.rest(), noise(body.rest().size(), 0.03, 15)),
               v = noise(body.rest().size(), 0.5, 16);
    EXPECT_LT(largest_difference(body.goals(x), other.goals(x)), TestFixture::kGoals);
    EXPECT_LT(largest_difference(body.step(x, v, 0, 0.01, 0.5), other.step(x, v, 0, 0.01, 0.5)),
              TestFixture::kGoals * 20);
  });
}

TYPED_TEST(Matching, NaiveAndSharedSumsGiveTheSameBits) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    Body<TypeParam> shared(lattice, w), naive(lattice, w, {}, SumMethod::kNaive);
    auto x = sum(shared.rest(), noise(shared.rest().size(), 0.02, 17)),
         v = noise(shared.rest().size(), 0.5, 18);
    for (int step = 0; step < 10; ++step) {
      const auto v_shared = shared.step(x, v, 0.7, 1.0 / 60, 0.1);
      const auto v_naive = naive.step(x, v, 0.7, 1.0 / 60, 0.1);
      ASSERT_EQ(v_shared, v_naive) << "step " << step;
      v = v_shared;
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += v[i] / 60;
    }
  });
}

TYPED_TEST(Matching, WithoutWidthNothingIsPulled) {
  for (const auto& [name, lattice] : test::all_lattices()) {
    Body<TypeParam> body(lattice, 0);
    const auto x = Body<TypeParam>::rounded(sum(body.rest(), noise(body.rest().size(), 0.3, 19)));
    EXPECT_LT(largest_difference(body.goals(x), x), TestFixture::kRigid) << name;
  }
}

TYPED_TEST(Matching, WithRegionsAsLargeAsTheBodyItIsGlobalShapeMatching) {
  for (const auto& [name, lattice] : test::all_lattices()) {
    if (name == "disconnected") continue;
    Body<TypeParam> body(lattice, kMaxHalfWidth);
    ASSERT_EQ(body.matcher().plan().regions(), 1u) << name;
    const auto x = sum(moved(body.rest(), Random(20).rotation().toRotationMatrix(), {1, 0, 0}),
                       noise(body.rest().size(), 0.03, 21));
    Vector3d centre = Vector3d::Zero(), centre0 = Vector3d::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) {
      centre += body.mass(i) / body.total_mass() * x[i];
      centre0 += body.mass(i) / body.total_mass() * body.rest()[i];
    }
    Matrix3d a = Matrix3d::Zero();
    for (std::size_t i = 0; i < x.size(); ++i)
      a += body.mass(i) * (x[i] - centre) * (body.rest()[i] - centre0).transpose();
    const Eigen::JacobiSVD<Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3d r = svd.matrixU() * svd.matrixV().transpose();
    ASSERT_GT(r.determinant(), 0);
    EXPECT_LT(largest_difference(body.goals(x), moved(body.rest(), r, centre - r * centre0)),
              TestFixture::kGoals)
        << name;
  }
}

TYPED_TEST(Matching, PartsThatDoNotTouchDoNotInfluenceEachOther) {
  const Lattice<3> lattice = lattice_from_cells(
      test::cells_where({7, 2, 2}, [](int x, int, int) { return x != 3; }), 0.1f, {0, 0, 0});
  for (int w = 1; w <= kLargestHalfWidth; ++w) {
    Body<TypeParam> body(lattice, w), other(lattice, w);
    const auto x = sum(body.rest(), noise(body.rest().size(), 0.01, 22)),
               v = noise(body.rest().size(), 0.5, 23);
    auto disturbed = x, faster = v;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (lattice.particles[i].x() <= 3) {
        disturbed[i] += Vector3d(0.01, -0.01, 0.01) * (i % 2 ? 1 : -1);
        faster[i] *= 2;
      }
    const auto before = body.step(x, v, 1, 0.02, 0.1), after = other.step(disturbed, faster, 1, 0.02, 0.1);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(before[i] == after[i], lattice.particles[i].x() > 3);
  }
}

TYPED_TEST(Matching, FlattenedCollapsedAndInvertedBodiesGetProperRotationsAndFiniteGoals) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    for (const Vector3d& scale :
         {Vector3d(1, 1, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 0), Vector3d(1, 1, -1),
          Vector3d(-0.5, -0.5, -0.5), Vector3d(1e-6, 1e-6, 1e-6), Vector3d(1e3, 1e3, 1e3)}) {
      Body<TypeParam> body(lattice, w);
      const auto x = moved(body.rest(), scale.asDiagonal(), Vector3d::Zero());
      for (int step = 0; step < 3; ++step)
        for (const Vector3d& v : body.step(x, noise(x.size(), 1, 24), 1, 1.0 / 60, 0.5))
          ASSERT_TRUE(v.allFinite());
      for (const auto& q : body.matcher().rotations()) ASSERT_NEAR(static_cast<double>(q.norm()), 1, 1e-6);
      for (const Vector3d& g : body.goals(x)) ASSERT_TRUE(g.allFinite());
    }
  });
}

TYPED_TEST(Matching, WorksFarFromTheOriginOfTheWorld) {
  const Lattice<3> lattice = test::block(5, 5, 5);
  Body<TypeParam> near(lattice, 2), far(lattice, 2);
  // On a grid that a float still resolves a kilometre away, so that both get the same shape.
  auto x = sum(near.rest(), noise(near.rest().size(), 0.03, 25));
  for (Vector3d& v : x) v = (v * 8192).array().round() / 8192;
  const Vector3d away(1024, -1024, 512);
  EXPECT_LT(largest_difference(far.goals(moved(x, Matrix3d::Identity(), away)),
                               moved(near.goals(x), Matrix3d::Identity(), away)),
            TestFixture::kFloat ? 1e-4 : 1e-11);  // a float's spacing at 1 km is 6e-5
  const auto still = noise(x.size(), 0, 0);
  EXPECT_LT(largest_difference(far.step(moved(x, Matrix3d::Identity(), away), still, 1, 1, 0),
                               near.step(x, still, 1, 1, 0)),
            TestFixture::kFloat ? 1e-6 : 1e-11);  // the pull is not rounded to world coordinates
}

TYPED_TEST(Matching, FloatAndDoubleAgree) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    Body<TypeParam> body(lattice, w);
    Body<double> oracle(lattice, w, {}, SumMethod::kNaive);
    const auto x = sum(body.rest(), noise(body.rest().size(), 0.03, 26)),
               v = noise(body.rest().size(), 1, 27);
    EXPECT_LT(largest_difference(body.goals(x), oracle.goals(x)), TestFixture::kGoals);
    EXPECT_LT(largest_difference(body.step(x, v, 0, 1, 1), oracle.step(x, v, 0, 1, 1)),
              TestFixture::kGoals * 20);
  });
}

TYPED_TEST(Matching, CopiedStateContinuesWithTheSameBits) {
  Body<TypeParam> body(test::block(4, 3, 2), 2);
  auto x = sum(body.rest(), noise(body.rest().size(), 0.04, 28));
  body.goals(x);
  Body<TypeParam> saved = body;
  x = sum(x, noise(x.size(), 0.01, 29));
  EXPECT_EQ(body.goals(x), saved.goals(x));
}

TYPED_TEST(Matching, AfterResetNothingIsRemembered) {
  Body<TypeParam> body(test::block(4, 3, 2), 1), fresh(test::block(4, 3, 2), 1);
  // Leaves the twist open.
  const auto flat = moved(body.rest(), Vector3d(1, 0, 0).asDiagonal(), Vector3d::Zero());
  body.goals(moved(body.rest(), Random(30).rotation().toRotationMatrix(), {1, 2, 3}));
  EXPECT_GT(largest_difference(body.goals(flat), fresh.goals(flat)), 1e-4);
  body.matcher().reset();
  fresh.matcher().reset();
  EXPECT_EQ(body.goals(flat), fresh.goals(flat));
}

TYPED_TEST(Matching, GoalsMayOverwriteThePositions) {
  Body<TypeParam> body(test::block(3, 3, 3), 1), other(test::block(3, 3, 3), 1);
  const auto x = sum(body.rest(), noise(body.rest().size(), 0.04, 31));
  auto in_place = Body<TypeParam>::narrow(x);
  other.matcher().goals(in_place, in_place);
  EXPECT_EQ(Body<TypeParam>::widen(in_place), body.goals(x));
}

TYPED_TEST(Matching, AllocatesNothingInAStep) {
  for (const SumMethod method : {SumMethod::kBarPlateCube, SumMethod::kNaive}) {
    Body<TypeParam> body(test::block(4, 4, 4), 2, {}, method);
    const auto x = Body<TypeParam>::narrow(sum(body.rest(), noise(body.rest().size(), 0.04, 32)));
    auto v = Body<TypeParam>::narrow(noise(x.size(), 1, 33)), g = v;
    const std::size_t before = softcell::test::allocations();
    for (int step = 0; step < 3; ++step) {
      body.matcher().step_velocities(x, v, TypeParam(1), TypeParam(0.01), TypeParam(0.1));
      body.matcher().goals(x, g);
    }
    body.matcher().reset();
    EXPECT_EQ(softcell::test::allocations(), before);
  }
}

TYPED_TEST(Matching, ReportsNumbersThatAreNotFiniteAndChangesNothing) {
  Body<TypeParam> body(test::block(2, 2, 2), 1);
  const auto good_x = Body<TypeParam>::narrow(body.rest()),
             good_v = Body<TypeParam>::narrow(noise(good_x.size(), 1, 34));
  const auto message_of = [&](const auto& x, auto v) {
    const auto before = v;
    try {
      body.matcher().step_velocities(x, v, TypeParam(1), TypeParam(0.01), TypeParam(0.1));
    } catch (const std::runtime_error& error) {
      for (std::size_t i = 0; i < v.size(); ++i)
        for (int d = 0; d < 3; ++d) EXPECT_TRUE(v[i][d] == before[i][d] || std::isnan(v[i][d]));
      return std::string(error.what());
    }
    return std::string("no error");
  };
  for (const TypeParam bad :
       {std::numeric_limits<TypeParam>::quiet_NaN(), std::numeric_limits<TypeParam>::infinity(),
        -std::numeric_limits<TypeParam>::infinity()}) {
    for (int d = 0; d < 3; ++d) {
      auto x = good_x, v = good_v;
      x[17][d] = v[5][d] = bad;
      EXPECT_EQ(message_of(x, good_v), "soft body: the position of particle 17 is not a finite number");
      EXPECT_EQ(message_of(good_x, v), "soft body: the velocity of particle 5 is not a finite number");
      EXPECT_THROW(body.matcher().goals(x, v), std::runtime_error);
    }
  }
  EXPECT_EQ(message_of(good_x, good_v), "no error");
}

TYPED_TEST(Matching, RefusesParametersOutOfRange) {
  Body<TypeParam> body(test::block(1, 1, 1), 1);
  const auto x = Body<TypeParam>::narrow(body.rest());
  auto v = x;
  const auto step = [&](double alpha, double h, double damping) {
    body.matcher().step_velocities(x, v, static_cast<TypeParam>(alpha), static_cast<TypeParam>(h),
                                   static_cast<TypeParam>(damping));
  };
  EXPECT_NO_THROW(step(0, 0.01, 0));
  EXPECT_NO_THROW(step(1, 0.01, 1));
  for (const double bad : {-0.01, 1.01, double{NAN}, double{INFINITY}}) {
    EXPECT_THROW(step(bad, 0.01, 0), std::invalid_argument);
    EXPECT_THROW(step(1, 0.01, bad), std::invalid_argument);
  }
  for (const double bad : {0.0, -0.01, double{NAN}, double{INFINITY}})
    EXPECT_THROW(step(1, bad, 0), std::invalid_argument);
  EXPECT_THROW(body.matcher().goals(std::span(x).first(7), v), std::invalid_argument);
  EXPECT_THROW(body.matcher().goals(x, std::span(v).first(7)), std::invalid_argument);
  EXPECT_THROW(body.matcher().step_velocities(x, std::span(v).first(7), 1, 1, 0), std::invalid_argument);
}

TYPED_TEST(Matching, RefusesMassesThatAreNone) {
  const Lattice<3> lattice = test::block(1, 1, 1);
  using Plan = MatchingPlan<TypeParam, 3>;
  EXPECT_THROW(Plan(lattice, 1, std::vector<float>(7, 1.0f)), std::invalid_argument);
  for (const float bad : {0.0f, -1.0f, NAN, INFINITY}) {
    std::vector<float> masses(8, 1.0f);
    masses[3] = bad;
    EXPECT_THROW(Plan(lattice, 1, masses), std::invalid_argument) << bad;
  }
  EXPECT_THROW(Plan(lattice, kMaxHalfWidth + 1, std::vector<float>(8, 1.0f)), std::runtime_error);
}

TYPED_TEST(Matching, RegionMassesAddUpToTheBody) {
  test::for_every_half_width(test::all_lattices(), 1, [](const Lattice<3>& lattice, int w) {
    const auto masses = uneven_masses(lattice.particles.size(), 35);
    const MatchingPlan<TypeParam, 3> plan(lattice, w, masses);
    double regions = 0, body = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      body += static_cast<double>(masses[i]);
      regions += static_cast<double>(plan.region_constants()[plan.sums().region_of()[i]].mass);
    }
    EXPECT_NEAR(regions / body, 1, TestFixture::kFloat ? 1e-6 : 1e-13);
  });
}

TEST(MatchingBits, AreTheSameForEveryCompilerAndBuild) {
  const std::vector<Eigen::Vector3i> cells = test::all_cells()[1].second;
  const Lattice<3> lattice = lattice_from_cells(cells, 0.125f, {0, 0, 0});
  Body<float> body(lattice, 2);
  auto x = Body<float>::narrow(body.rest()), v = Body<float>::narrow(noise(x.size(), 2, 36));
  for (int step = 0; step < 300; ++step) {
    body.matcher().step_velocities(x, v, 0.75f, 1.0f / 64, 0.02f);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += v[i] * (1.0f / 64);
  }
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const Eigen::Vector3f& position : x)
    for (int d = 0; d < 3; ++d) hash = (hash ^ std::bit_cast<std::uint32_t>(position[d])) * 0x100000001b3u;
  // Changes with any change of the arithmetic; never with the compiler, its options, or the host.
  EXPECT_EQ(hash, 0xf747525b1416b5e5u);
}

}  // namespace
}  // namespace softcell::ppu
