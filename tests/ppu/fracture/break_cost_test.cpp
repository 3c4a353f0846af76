// What a break costs the thread that steps the world: no substep takes much longer because pieces come. (docs/notes/performance.md has
// figures; here only that a frame is not lost, as machines may be busy.)
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>
#include <vector>

#include "../contacts/contact_world.h"
#include "../soft_body_2d_scenes.h"
#include "ppu/bodies/processor_time.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/shapes.h"
#include "support/median.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// Of a substep, milliseconds of this thread's processor time: what another one computes does not stall it. Afterwards the pieces touch along the whole cut, which is contact and no stall.
struct Cost {
  double before = 0, with_pieces = 0, next = 0, afterwards = 0;
  double stall() const { return std::max(with_pieces - before, next - afterwards); }
};

/// Cuts the only body of a world and steps it until there are two.
/// @param bodies  of the world: both couplings have the same functions
template <typename Bodies, typename Cut, typename Substep>
Cost cost_of_break(Bodies& bodies, const Cut& where, const Substep& substep) {
  const auto timed = [&] {
    const auto begin = processor_time();
    substep();
    const std::chrono::duration<double, std::milli> took = processor_time() - begin;
    std::this_thread::sleep_for(std::chrono::milliseconds(8));  // the rest of a frame
    return took.count();
  };
  const auto median_of_five = [&] {
    std::vector<double> each;
    for (int i = 0; i < 5; ++i) each.push_back(timed());
    return median(each);
  };
  Cost cost{.before = median_of_five()};
  EXPECT_TRUE(bodies.begin_cut(bodies[0], where));
  for (int i = 0; i < 100 && bodies.size() == 1; ++i) cost.with_pieces = timed();
  EXPECT_EQ(bodies.size(), 2u);
  cost.next = timed();
  cost.afterwards = median_of_five();
  return cost;
}

/// Prints the run of three that stalls least, and holds it to a multiple of what a quiet machine keeps to.
template <typename Run>
void expect_no_stall(const char* what, double most_ms, const Run& run) {
  std::size_t particles = 0;
  Cost least = run(particles);
  for (int i = 0; i < 2; ++i)
    if (const Cost cost = run(particles); cost.stall() < least.stall()) least = cost;
  std::printf(
      "%s, %zu particles: a substep %.2f ms, that with pieces %.2f ms, the next one %.2f ms, those "
      "afterwards %.2f ms\n",
      what, particles, least.before, least.with_pieces, least.next, least.afterwards);
  constexpr double kBusy = 4;
  EXPECT_LT(least.stall(), kBusy * most_ms);
}

constexpr std::pair<int, double> kSizes[] = {{1000, 0.5}, {20000, 2.5}};  // particles, milliseconds

/// A sphere whose halves fly apart.
TEST(BreakCost, NoSubstepOfASphereStallsWhenPiecesCome) {
  if (kSlowBuild) GTEST_SKIP() << "it measures time, which sanitizers change";
  for (const auto& [size, most_ms] : kSizes) {
    const float cell = size == 1000 ? 1 / 12.0f : 1 / 33.0f;
    const auto model = make_soft_body_model(
        make_sphere(0.5f, 3), {.cell_size = cell, .half_width = 2, .alpha = 0.5f, .damping = 0.1f});
    expect_no_stall("a sphere", most_ms, [&](std::size_t& particles) {
      ContactWorld world({0, 0, 0});
      SoftBody<3>& ball = world.bodies.add(model, {0, 0, 0});
      particles = model->particles();
      for (std::size_t p = 0; p < particles; ++p)
        ball.add_particle_velocity(p, Vector3f(ball.position(p).x() > 0 ? 0.5f : -0.5f, 0, 0));
      return cost_of_break(world.bodies, Cut::plane({0.001f, 0, 0}, {1, 0, 0}), [&] { world.run(1, 1); });
    });
  }
}

TEST(BreakCost, NoStepOfASquareStallsWhenPiecesCome) {
  if (kSlowBuild) GTEST_SKIP() << "it measures time, which sanitizers change";
  for (const auto& [size, most_ms] : kSizes) {
    const int edge = size == 1000 ? 31 : 140;
    const auto model =
        rectangle_model({edge, edge}, {.cell_size = 0.05f, .half_width = 2, .alpha = 0.5f, .damping = 0.1f});
    expect_no_stall("a square", most_ms, [&](std::size_t& particles) {
      World2d world(0, ContactMethod::kSurface);
      SoftBody<2>& square = world.soft.add(model, {0, 0});
      particles = model->particles();
      for (std::size_t p = 0; p < particles; ++p)
        square.add_particle_velocity(p, Vector2f(square.position(p).x() > 0 ? 0.5f : -0.5f, 0));
      return cost_of_break(world.soft, Cut2d::line({0.001f, 0}, {1, 0}), [&] { world.soft.step(kStep); });
    });
  }
}

}  // namespace
}  // namespace softcell::ppu
