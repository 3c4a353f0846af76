// What the kernels are measured against does the same work: its steps are those of the PPU's solvers.

#include "ppu/reference/eigen_solver.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "lattices.h"
#include "lattices_2d.h"
#include "particle_vectors.h"
#include "ppu/reference/shape_matching.h"

namespace softcell::ppu {
namespace {

using test::Random;

constexpr float kAlpha = 0.5f, kSeconds = 1.0f / 60, kDamping = 0.2f;

/// Steps from the same shaken state, in both.
template <int Dimension>
void expect_the_same_steps(const Lattice<Dimension>& lattice, int half_width) {
  using Vector = Eigen::Matrix<float, Dimension, 1>;
  const auto plan = std::make_shared<const MatchingPlan<float, Dimension>>(lattice, half_width,
                                                                           particle_masses(lattice, 1000));
  EigenSolver<Dimension> solver(plan);
  ShapeMatcher<float, Dimension> matcher(plan);
  Random random(1);
  std::vector<Vector> x(plan->particles());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = lattice.rest_position(i);
    for (int d = 0; d < Dimension; ++d) x[i][d] += 0.02f * static_cast<float>(random.next());
  }
  std::vector<Vector> mine(x.size(), Vector::Zero()), expected = mine;
  for (int step = 0; step < 3; ++step) {
    solver.step(x, mine, kAlpha, kSeconds, kDamping);
    matcher.step_velocities(x, expected, kAlpha, kSeconds, kDamping);
    EXPECT_GT(test::largest_difference(expected, std::vector<Vector>(x.size(), Vector::Zero())), 0.01);
    EXPECT_LT(test::largest_difference(mine, expected), 2e-4) << "m/s, step " << step;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += kSeconds * expected[i];
  }
}

TEST(EigenSolver, StepsAsTheReferenceInThreeDimensions) {
  test::for_every_half_width(test::all_lattices(), 1, expect_the_same_steps<3>);
}

TEST(EigenSolver, StepsAsTheReferenceInTwoDimensions) {
  test::for_every_half_width(test::all_lattices_2d(), 1, expect_the_same_steps<2>);
}

}  // namespace
}  // namespace softcell::ppu
