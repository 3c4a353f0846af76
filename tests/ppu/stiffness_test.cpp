// What a soft body does over many steps, against closed forms: stiffness, waves, periods, energy, rest.

#include "ppu/matching/stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "lattices.h"
#include "ppu/numbers/deterministic_math.h"
#include "ppu/reference/shape_matching.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using test::Random;

/// A body without an engine: semi-implicit Euler steps in double precision.
struct Simulation {
  Simulation(const Lattice<3>& body, int half_width)
      : lattice(body),
        masses(particle_masses(lattice, 1000)),
        matcher(std::make_shared<const MatchingPlan<double, 3>>(lattice, half_width, masses)) {
    const double s = static_cast<double>(lattice.spacing);
    for (const auto& particle : lattice.particles) x.push_back(s * particle.cast<double>());
    v.assign(x.size(), Vector3d::Zero());
  }
  void match(double alpha, double h, double damping) { matcher.step_velocities(x, v, alpha, h, damping); }
  void move(double h) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * v[i];
  }
  double kinetic_energy() const {
    double energy = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      energy += 0.5 * static_cast<double>(masses[i]) * v[i].squaredNorm();
    return energy;
  }

  Lattice<3> lattice;
  std::vector<float> masses;
  ShapeMatcher<double, 3> matcher;
  std::vector<Vector3d> x, v;
};

TEST(Stiffness, OfABarPulledAtItsEndsIsTheFormula) {
  constexpr double kStep = 1.0 / 60, kDensity = 1000;
  constexpr int kCells = 40;
  for (int w = 1; w <= 3; ++w) {
    for (const double alpha : {1.0, 0.4}) {
      Simulation bar(test::block(kCells, 1, 1), w);
      const double s = static_cast<double>(bar.lattice.spacing);
      const double modulus = kDensity * specific_modulus(s, kStep, alpha, w);
      const double force = 0.01 * modulus * s * s;  // stretches by 1 %
      for (int step = 0; step < 6000; ++step) {
        for (Vector3d& v : bar.v) v *= 0.95;  // a resistance of the air, so that it comes to rest
        bar.match(alpha, kStep, 0);
        for (std::size_t i = 0; i < bar.x.size(); ++i) {
          const int at = bar.lattice.particles[i].x();
          if (at == 0 || at == kCells)
            bar.v[i].x() += (at == 0 ? -1 : 1) * kStep * force / 4 / static_cast<double>(bar.masses[i]);
        }
        bar.move(kStep);
      }
      EXPECT_LT(bar.kinetic_energy(), 1e-9);  // at rest
      constexpr int kFrom = 10, kTo = 30;     // away from the ends, which the regions cut
      double from = 0, to = 0;
      for (std::size_t i = 0; i < bar.x.size(); ++i) {
        if (bar.lattice.particles[i].x() == kFrom) from += bar.x[i].x() / 4;
        if (bar.lattice.particles[i].x() == kTo) to += bar.x[i].x() / 4;
      }
      const double strain = (to - from) / ((kTo - kFrom) * s) - 1;
      EXPECT_NEAR(0.01 / strain, 1, 0.002) << "w " << w << " alpha " << alpha;
    }
  }
}

TEST(Stiffness, OfPlaneWavesIsTheTransferFunction) {
  for (int w = 1; w <= 4; ++w) {
    const int half = 3 * w + 1;  // far enough that the centre sees full regions of full weights only
    Simulation block(test::block(2 * half, 2 * half, 2 * half), w);
    const double s = static_cast<double>(block.lattice.spacing), amplitude = 1e-6 * s;
    const int n = 2 * w + 1;
    std::size_t centre = 0;
    while (block.lattice.particles[centre] != Eigen::Vector3i(half, half, half)) ++centre;
    const auto rest = block.x;
    for (const double k : {0.2, 0.5, 1.0}) {
      const double b = std::sin(n * k / 2) / (n * std::sin(k / 2));
      double first = 0, second = 0;
      for (int j = -w; j <= w; ++j) first += j * std::sin(k * j), second += j * j;
      const double transfer[2] = {b * b, b * b + first * first / (2 * n * second)};
      for (const int direction : {0, 1}) {  // along the wave: longitudinal; across: transverse
        for (std::size_t i = 0; i < rest.size(); ++i) {
          block.x[i] = rest[i];
          block.x[i][direction] += amplitude * std::cos(k * (block.lattice.particles[i].x() - half));
        }
        std::vector<Vector3d> goals(rest.size());
        block.matcher.goals(block.x, goals);
        EXPECT_NEAR((goals[centre] - rest[centre])[direction] / amplitude, transfer[direction], 1e-4)
            << "w " << w << " k " << k << " direction " << direction;
      }
    }
  }
}

TEST(Stiffness, AlphaFromFrequencyIsThePeriodOfAMode) {
  constexpr double kSeconds = 20;
  for (const double h : {1.0 / 60, 1.0 / 240}) {
    for (const double frequency : {1.0, 4.0, 9.0}) {
      const double alpha = alpha_from_frequency(frequency, h);
      Simulation cube(test::block(1, 1, 1), 1);  // one region: goals are fixed, every mode swings alike
      for (std::size_t i = 0; i < cube.x.size(); ++i)
        cube.x[i].x() += (cube.lattice.particles[i].x() - 0.5) * 1e-4;
      double stretch = 1;
      int crossings = 0;
      const int steps = static_cast<int>(kSeconds / h + 0.5);
      for (int step = 0; step < steps; ++step) {
        cube.match(alpha, h, 0);
        cube.move(h);
        const double now = cube.x[7].x() - cube.x[0].x() - 0.1;
        if ((now < 0) != (stretch < 0)) ++crossings;
        stretch = now;
      }
      EXPECT_NEAR(crossings / (2 * kSeconds), frequency, 1.0 / kSeconds) << "h " << h;
    }
  }
}

TEST(Stiffness, AlphaFromFrequencyKeepsToItsRange) {
  EXPECT_EQ(alpha_from_frequency(0, 0.01), 0);
  EXPECT_NEAR(alpha_from_frequency(5, 0.01), 4 * std::pow(std::sin(kPi * 0.05), 2), 1e-15);
  EXPECT_NEAR(alpha_from_frequency(0.9999999 / 6, 1), 1, 1e-6);
  EXPECT_EQ(alpha_from_frequency(10, 1.0 / 60), 1);  // a sixth of the step rate
  EXPECT_EQ(alpha_from_frequency(60, 1.0 / 60), 1);  // and beyond: no aliasing back to 0
  EXPECT_EQ(alpha_from_frequency(1e300, 1e300), 1);
  for (const double bad : {-1.0, double{NAN}, double{INFINITY}})
    EXPECT_THROW(alpha_from_frequency(bad, 0.01), std::invalid_argument);
  for (const double bad : {0.0, -1.0, double{NAN}, double{INFINITY}})
    EXPECT_THROW(alpha_from_frequency(1, bad), std::invalid_argument);
}

TEST(Stiffness, DampingFromTimeConstantKeepsToItsRange) {
  EXPECT_EQ(damping_from_time_constant(0, 0.01), 1);
  EXPECT_NEAR(damping_from_time_constant(0.5, 0.01), 1 - std::exp(-0.02), 1e-15);
  EXPECT_EQ(damping_from_time_constant(std::numeric_limits<double>::infinity(), 0.01), 0);
  EXPECT_EQ(damping_from_time_constant(1e-300, 1), 1);
  for (const double bad : {-1.0, double{NAN}})
    EXPECT_THROW(damping_from_time_constant(bad, 0.01), std::invalid_argument);
  for (const double bad : {0.0, -1.0, double{NAN}, double{INFINITY}})
    EXPECT_THROW(damping_from_time_constant(1, bad), std::invalid_argument);
}

TEST(Stiffness, DampingFromTimeConstantIsTheDecayOfAMode) {
  constexpr double kTau = 0.3;
  for (const double h : {1.0 / 60, 1.0 / 240}) {
    Simulation cube(test::block(1, 1, 1), 1);
    for (std::size_t i = 0; i < cube.v.size(); ++i) cube.v[i].x() = cube.lattice.particles[i].x() - 0.5;
    const double k = damping_from_time_constant(kTau, h);
    const int steps = static_cast<int>(kTau / h + 0.5);
    for (int step = 0; step < steps; ++step) cube.match(0, h, k);
    EXPECT_NEAR(cube.v[7].x(), 0.5 * std::exp(-1.0), 1e-6);
  }
}

TEST(Stiffness, SpecificModulusOfTheExamples) {
  const double expected[] = {24, 72, 144, 240};  // s = 0.1 m, h = 1/60 s
  for (int w = 1; w <= 4; ++w) EXPECT_NEAR(specific_modulus(0.1, 1.0 / 60, 1, w), expected[w - 1], 1e-9);
  EXPECT_EQ(specific_modulus(0.1, 0.01, 1, 0), 0);
  EXPECT_THROW(specific_modulus(0, 0.01, 1, 1), std::invalid_argument);
  EXPECT_THROW(specific_modulus(0.1, NAN, 1, 1), std::invalid_argument);
  EXPECT_THROW(specific_modulus(0.1, 0.01, 1.5, 1), std::invalid_argument);
  EXPECT_THROW(specific_modulus(0.1, 0.01, 1, -1), std::invalid_argument);
}

TEST(Energy, StaysBoundedWithoutDamping) {
  for (const double h : {1.0 / 240, 1.0 / 60, 0.1}) {
    for (const int w : {1, 2}) {
      for (const double alpha : {0.25, 1.0}) {
        Simulation body(test::block(3, 3, 2), w);
        Random random(40);
        for (Vector3d& v : body.v) v = random.vector() * (0.1 / 5 / h / std::sqrt(3.0));  // |v| h <= s / 5
        const double before = body.kinetic_energy();
        double most = 0;
        for (int step = 0; step < (kSlowBuild ? 1000 : 10000); ++step) {
          body.match(alpha, h, 0);
          body.move(h);
          most = std::max(most, body.kinetic_energy());
        }
        EXPECT_LT(most, 1.1 * before) << "h " << h << " w " << w << " alpha " << alpha;
      }
    }
  }
}

TEST(Energy, ADampedBodyComesToRestOnAFloor) {
  constexpr double kStep = 1.0 / 60, kGravity = 9.8, kAlpha = 1.0;
  Simulation body(test::block(4, 4, 4), 2);
  for (Vector3d& x : body.x) x.z() += 0.2;
  for (int step = 0; step < 1200; ++step) {
    for (Vector3d& v : body.v) v.z() -= kStep * kGravity;
    body.match(kAlpha, kStep, 0.1);
    for (std::size_t i = 0; i < body.x.size(); ++i)  // a floor at 0: no particle goes through, none is pulled
      if (body.x[i].z() + kStep * body.v[i].z() < 0) body.v[i].z() = -body.x[i].z() / kStep;
    body.move(kStep);
  }
  double height = 0;
  for (const Vector3d& x : body.x) {
    EXPECT_GE(x.z(), -1e-12);
    height = std::max(height, x.z());
  }
  for (const Vector3d& v : body.v) EXPECT_LT(v.norm(), 1e-3);
  EXPECT_GT(height, 0.35);  // of 0.4 m: it stands, a little lower than at rest
  EXPECT_LT(height, 0.4);
}

}  // namespace
}  // namespace softcell::ppu
