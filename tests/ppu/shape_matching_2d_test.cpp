// Shape matching in two dimensions keeps what the equations promise, on lattices of every kind, in float and
// double.

#include "ppu/reference/shape_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "ppu/matching/regions.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

/// Lattices by name: a block, an L with a hole, a bar one cell thick, two blocks that do not touch.
Lattice<2> lattice_of(const std::string& name) {
  const std::vector<std::string> rows = name == "block" ? std::vector<std::string>{"#####", "#####", "#####"}
                                        : name == "hole"
                                            ? std::vector<std::string>{"####..", "#..#..", "######"}
                                        : name == "bar"   ? std::vector<std::string>{"########"}
                                        : name == "apart" ? std::vector<std::string>{"##..###", "##..###"}
                                                          : std::vector<std::string>{"#"};
  return lattice_from_cells(cells_from_rows(rows), 0.25f, {1, -2});
}

std::vector<float> uneven_masses(const Lattice<2>& lattice) {
  std::vector<float> masses = particle_masses(lattice, 3);
  for (std::size_t i = 0; i < masses.size(); ++i) masses[i] *= 1 + 0.5f * static_cast<float>(i % 3);
  return masses;
}

template <typename Real>
struct Body {
  using Vector = Eigen::Matrix<Real, 2, 1>;
  Body(const Lattice<2>& lattice, int half_width, SumMethod method = SumMethod::kBarPlateCube)
      : masses(uneven_masses(lattice)),
        matcher(std::make_shared<const MatchingPlan<Real, 2>>(lattice, half_width, masses), method) {
    for (std::size_t i = 0; i < masses.size(); ++i)
      rest.push_back(lattice.rest_position(i).template cast<Real>());
  }
  std::vector<Vector> scattered(unsigned seed, double by) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-by, by);
    std::vector<Vector> x = rest;
    for (Vector& p : x) p += Vector(static_cast<Real>(offset(random)), static_cast<Real>(offset(random)));
    return x;
  }
  std::vector<Vector> goals(const std::vector<Vector>& x) {
    std::vector<Vector> g(x.size());
    matcher.goals(x, g);
    return g;
  }
  std::vector<float> masses;
  std::vector<Vector> rest;
  ShapeMatcher<Real, 2> matcher;
};

class Matching2d : public testing::TestWithParam<std::tuple<std::string, int>> {
 protected:
  Lattice<2> lattice_ = lattice_of(std::get<0>(GetParam()));
  int w_ = std::get<1>(GetParam());
};

TEST_P(Matching2d, ConservesBothMomenta) {
  Body<double> body(lattice_, w_);
  const auto x = body.scattered(1, 0.4);
  const auto g = body.goals(x);
  Vector2d linear = Vector2d::Zero();
  double angular = 0, size = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector2d pull = double{body.masses[i]} * (g[i] - x[i]);
    linear += pull;
    angular += x[i].x() * pull.y() - x[i].y() * pull.x();
    size += pull.norm();
  }
  EXPECT_LT(linear.norm(), 1e-12 * (1 + size));
  EXPECT_LT(std::abs(angular), 1e-11 * (1 + size));
  EXPECT_EQ(size > 1e-3, w_ > 0) << "pulls add up to " << size;
}

TEST_P(Matching2d, LeavesRigidMotionAlone) {
  Body<double> body(lattice_, w_);
  const Eigen::Rotation2Dd turn(2.3);
  std::vector<Vector2d> x, v;
  for (const Vector2d& p : body.rest) {
    x.push_back(turn * p + Vector2d(3, -5));
    v.push_back(Vector2d(0.5, 1) + 0.7 * Vector2d(-x.back().y(), x.back().x()));
  }
  const auto g = body.goals(x);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((g[i] - x[i]).norm(), 1e-13);
  auto damped = v;
  body.matcher.step_velocities(x, damped, 0.0, 0.01, 0.5);
  for (std::size_t i = 0; i < v.size(); ++i) EXPECT_LT((damped[i] - v[i]).norm(), 1e-11);
}

TEST_P(Matching2d, TurnsWithTheBody) {
  Body<double> body(lattice_, w_);
  const auto x = body.scattered(2, 0.3);
  const auto g = body.goals(x);
  const Eigen::Rotation2Dd turn(-1.1);
  std::vector<Vector2d> turned;
  for (const Vector2d& p : x) turned.push_back(turn * p + Vector2d(1, 2));
  const auto turned_goals = body.goals(turned);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_LT((turned_goals[i] - (turn * g[i] + Vector2d(1, 2))).norm(), 1e-12);
  }
}

TEST_P(Matching2d, SharedSumsHaveTheBitsOfNaiveOnes) {
  Body<float> shared(lattice_, w_), naive(lattice_, w_, SumMethod::kNaive);
  const auto x = shared.scattered(3, 0.3);
  std::vector<Eigen::Vector2f> v1(x.size(), {1, 2}), v2 = v1;
  for (std::size_t i = 0; i < v1.size(); ++i) v2[i] = v1[i] = {std::sin(static_cast<float>(i)), 0.5f};
  shared.matcher.step_velocities(x, v1, 0.7f, 0.01f, 0.2f);
  naive.matcher.step_velocities(x, v2, 0.7f, 0.01f, 0.2f);
  EXPECT_EQ(v1, v2);
}

TEST_P(Matching2d, DampingKeepsMomentaAndTakesEnergy) {
  Body<double> body(lattice_, w_);
  const auto x = body.scattered(4, 0.1);
  std::vector<Vector2d> v = body.scattered(5, 1);
  const auto before = v;
  body.matcher.step_velocities(x, v, 0.0, 0.01, 0.4);
  Vector2d linear = Vector2d::Zero();
  double angular = 0, energy_before = 0, energy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector2d change = double{body.masses[i]} * (v[i] - before[i]);
    linear += change;
    angular += x[i].x() * change.y() - x[i].y() * change.x();
    energy_before += double{body.masses[i]} * before[i].squaredNorm();
    energy += double{body.masses[i]} * v[i].squaredNorm();
  }
  EXPECT_LT(linear.norm(), 1e-12);
  EXPECT_LT(std::abs(angular), 1e-11);
  EXPECT_LE(energy, energy_before * (1 + 1e-14));
}

TEST_P(Matching2d, FloatAgreesWithDouble) {
  Body<double> exact(lattice_, w_);
  Body<float> single(lattice_, w_);
  const auto x = single.scattered(6, 0.2);
  std::vector<Vector2d> wide;
  for (const auto& p : x) wide.push_back(p.cast<double>());
  const auto g = single.goals(x);
  const auto reference = exact.goals(wide);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((g[i].cast<double>() - reference[i]).norm(), 3e-6);
}

INSTANTIATE_TEST_SUITE_P(Lattices, Matching2d,
                         testing::Combine(testing::Values<std::string>("block", "hole", "bar", "apart",
                                                                       "cell"),
                                          testing::Values(0, 1, 2, 4)),
                         [](const auto& parameters) {
                           return std::get<0>(parameters.param) + "_w" +
                                  std::to_string(std::get<1>(parameters.param));
                         });

TEST(Matching2dCases, AWidthAboveTheBodyIsOneRigidRegion) {
  Body<double> body(lattice_of("block"), 9);
  EXPECT_EQ(body.matcher.plan().regions(), 1u);
  const auto x = body.scattered(7, 0.2);
  // Brute force over the angle: no other does better.
  const auto g = body.goals(x);
  Vector2d centre = Vector2d::Zero(), rest_centre = Vector2d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    centre += double{body.masses[i]} * x[i];
    rest_centre += double{body.masses[i]} * body.rest[i];
    mass += double{body.masses[i]};
  }
  centre /= mass;
  rest_centre /= mass;
  const auto cost = [&](double angle) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += double{body.masses[i]} *
             (Eigen::Rotation2Dd(angle) * (body.rest[i] - rest_centre) + centre - x[i]).squaredNorm();
    return sum;
  };
  double found = 0;
  for (std::size_t i = 0; i < x.size(); ++i) found += double{body.masses[i]} * (g[i] - x[i]).squaredNorm();
  for (double angle = -3.14; angle < 3.14; angle += 0.001) EXPECT_GE(cost(angle), found - 1e-12);
}

TEST(Matching2dCases, PartsThatDoNotTouchNeverInfluenceEachOther) {
  Body<float> body(lattice_of("apart"), 4);
  auto x = body.scattered(8, 0.2);
  const auto before = body.goals(x);
  x.back() += Eigen::Vector2f(0.05f, -0.03f);  // within the same grid point's reach of the mean
  const auto after = body.goals(x);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(before[i], after[i]) << i;
  EXPECT_NE(before.back(), after.back());
}

TEST(Matching2dCases, AllOnOnePointKeepsTheDirection) {
  Body<float> body(lattice_of("block"), 2);
  std::vector<Eigen::Vector2f> x;
  for (const auto& p : body.rest) x.push_back(Eigen::Rotation2Df(1) * p);
  body.goals(x);
  const Eigen::Vector2f direction = body.matcher.rotations()[0];
  EXPECT_NEAR(direction.x(), std::cos(1.0f), 1e-5f);
  body.goals(std::vector<Eigen::Vector2f>(x.size(), Eigen::Vector2f(4, 4)));
  EXPECT_EQ(body.matcher.rotations()[0], direction);
}

/// E / rho = (s/h)^2 alpha w (w+1) / 3 for long waves: the transfer of a plane wave of displacement.
TEST(Matching2dCases, StiffnessIsThatOfTheFormula) {
  constexpr int kLength = 64, kHeight = 64, kHalfWidth = 2;
  std::vector<Vector2i> cells;
  for (int x = 0; x < kLength; ++x)
    for (int y = 0; y < kHeight; ++y) cells.push_back({x, y});
  const Lattice<2> lattice = lattice_from_cells(cells, 1);
  const std::vector<float> masses(lattice.particles.size(), 1.0f);
  ShapeMatcher<double, 2> matcher(
      std::make_shared<const MatchingPlan<double, 2>>(lattice, kHalfWidth, masses));
  const double wave = 2 * 3.14159265358979 / 32, amplitude = 1e-4;
  std::vector<Vector2d> x(masses.size()), g(masses.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = lattice.rest_position(i).cast<double>();
    x[i].x() += amplitude * std::sin(wave * x[i].x());
  }
  matcher.goals(x, g);
  // In the middle, far from edges: pull = -(E/rho) k^2 u h^2 / (s^2 alpha).
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (lattice.particles[i] != Vector2i(40, 32)) continue;  // a crest: sin(2 pi 40/32) = 1
    const double pull = g[i].x() - x[i].x();
    const double modulus = -pull / (wave * wave * amplitude);
    EXPECT_NEAR(modulus, kHalfWidth * (kHalfWidth + 1) / 3.0, 0.05 * 2);
  }
}

TEST(Matching2dCases, BadArgumentsAreNamed) {
  const Lattice<2> lattice = lattice_of("block");
  Body<float> body(lattice, 1);
  auto x = body.rest;
  std::vector<Eigen::Vector2f> v(x.size(), {0, 0});
  EXPECT_THROW(body.matcher.step_velocities(x, v, 1.5f, 0.01f, 0.f), std::invalid_argument);
  EXPECT_THROW(body.matcher.step_velocities(x, v, 0.5f, 0.f, 0.f), std::invalid_argument);
  x[3].x() = std::nanf("");
  try {
    body.matcher.step_velocities(x, v, 0.5f, 0.01f, 0.f);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("particle 3"), std::string::npos) << error.what();
  }
}

TEST(Lattice2d, FromRowsOfText) {
  const std::vector<std::string> rows{"#.", "##"};
  const Lattice<2> lattice = lattice_from_cells(cells_from_rows(rows), 0.5f, {1, 1});
  EXPECT_EQ(lattice.cells, (std::vector<Vector2i>{{0, 0}, {0, 1}, {1, 0}}));
  EXPECT_EQ(lattice.particles.size(), 8u);
  EXPECT_EQ(lattice.rest_position(7), Eigen::Vector2f(2, 1.5f));
  EXPECT_EQ(lattice.corners[0], (std::array<std::uint32_t, 4>{0, 3, 1, 4}));
  EXPECT_EQ(lattice.neighbours[4].size(), 7u) << "the corner of all three cells";
  const auto outer = outer_particles(lattice);
  EXPECT_TRUE(std::all_of(outer.begin(), outer.end(), [](bool b) { return b; }));
  double mass = 0;
  for (const float m : particle_masses(lattice, 4)) mass += m;
  EXPECT_DOUBLE_EQ(mass, 4 * 3 * 0.25);
}

TEST(Lattice2d, BadOnesAreNamed) {
  const auto message = [](const auto& make) -> std::string {
    try {
      make();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  const std::vector<std::string> rows{"##", "#x"};
  EXPECT_EQ(message([&] { cells_from_rows(rows); }),
            "a lattice's rows are made of '#', '.' and ' '; row 2 has 'x' in column 2");
  EXPECT_NE(message([] { lattice_from_cells(std::vector<Vector2i>{}, 1); }).find("at least one cell"),
            std::string::npos);
  const std::vector<Vector2i> far_apart{{0, 0}, {300, 0}};
  EXPECT_NE(message([&] { lattice_from_cells(far_apart, 1); }).find("301 along x"), std::string::npos);
  EXPECT_NE(message([&] { lattice_from_cells(far_apart, -1); }).find("positive number"), std::string::npos);
}

}  // namespace
}  // namespace softcell::ppu
