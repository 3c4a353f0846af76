// Scene arena for a long time: no body gets lost, no number goes bad, no memory is lost. ci/soak runs it for
// 10,000 simulated seconds.

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/base/sanitizers.h"
#include "softcell/soft_bodies/skinned_mesh.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

constexpr int kFramesASecond = 60;

// A sanitizer keeps freed memory for a while, so that there is nothing to be learnt from its amount.
constexpr bool kMemoryIsMeasured = SC_ADDRESS_SANITIZER == 0 && SC_THREAD_SANITIZER == 0;

/// The resident memory of this process, megabytes.
double memory_in_use() {
  std::ifstream file("/proc/self/statm");
  double program = 0, resident = 0;
  file >> program >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// So deep, in cells, a hard landing presses what is drawn into the floor, which pushes it out within a second.
constexpr float kDeepestInCells = 0.15f;

const Scene& arena() {
  static const Scene scene = load_scene_3d("arena");
  return scene;
}

/// Simulated seconds.
int wanted_seconds() {
  const char* const wanted = std::getenv("SOFTCELL_SOAK_SECONDS");
  return wanted != nullptr ? std::max(std::atoi(wanted), 6) : 12;
}

/// Where the walls end. They are 0.9 m high: a body may lean over one, but its middle stays inside.
bool between_walls(const Eigen::Vector3f& x) { return std::max(std::abs(x.x()), std::abs(x.z())) < 4.8f; }

/// The box around what is drawn, computed here: a SurfaceQuery builds a tree, for thousands of frames.
Eigen::AlignedBox3f drawn_bounds(const ppu::SoftBody<3>& body) {
  std::vector<Eigen::Vector3f> positions(body.model().mesh().positions.size()), normals(positions.size());
  EXPECT_FALSE(positions.empty());
  ppu::skin(body, positions, normals);
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& x : positions) bounds.extend(x);
  return bounds;
}

void expect_nothing_lost(const Simulation3d& simulation) {
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    const ppu::SoftBody<3>& body = simulation.soft_body(b);
    const std::string& name = arena().soft_bodies[b].name;
    for (std::size_t i = 0; i < body.model().particles(); ++i) {
      const Eigen::Vector3f x = body.position(i);
      ASSERT_TRUE(x.allFinite() && body.velocities()[i].allFinite()) << name;
    }
    const Eigen::AlignedBox3f drawn = drawn_bounds(body);
    if (between_walls(drawn.min()) && between_walls(drawn.max())) {
      ASSERT_GT(drawn.min().y(), -kDeepestInCells * body.model().settings().cell_size)
          << name << " is in the floor";
    }
    const Eigen::Vector3f middle = body.centre_of_mass();
    ASSERT_TRUE(between_walls(middle) && middle.y() < 10) << name << " is at " << middle.transpose();
  }
  for (const Eigen::Matrix4f& pose : simulation.shown_box_poses())
    ASSERT_TRUE(pose.allFinite() && pose(1, 3) > -0.6f) << pose;
}

/// Root of the particles' mean squared distance from their middle.
template <typename Position>
double radius_of_gyration(const ppu::SoftBody<3>& body, const Position& position) {
  const std::size_t count = body.model().particles();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d x = position(i).template cast<double>();
    sum += x;
    squares += x.squaredNorm();
  }
  const auto n = static_cast<double>(count);
  return std::sqrt(squares / n - (sum / n).squaredNorm());
}

/// What is drawn; a crush may take it lower for a moment.
void expect_surfaces_above_the_floor(const Simulation3d& simulation) {
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b)
    ASSERT_GT(drawn_bounds(simulation.soft_body(b)).min().y(), -0.1f) << arena().soft_bodies[b].name;
}

TEST(Soak, NothingIsLostInALongTime) {
  const int seconds = wanted_seconds();
  Simulation3d simulation(arena(), {});
  std::vector<double> memory;  // after each second
  for (int second = 1; second <= seconds; ++second) {
    for (int frame = 0; frame < kFramesASecond; ++frame) simulation.step();
    ASSERT_NO_FATAL_FAILURE(expect_nothing_lost(simulation)) << "after " << second << " s";
    memory.push_back(memory_in_use());
    if (second % 100 == 0) {
      std::printf("%d of %d s, %.1f MB\n", second, seconds, memory.back());
      std::fflush(stdout);
    }
  }
  if (!kMemoryIsMeasured) return;
  // Bullet's arrays grow to what the fullest moment needs. Whatever is lost in each frame, four bytes or
  // more, goes on and on.
  const double third = *std::max_element(memory.begin(), memory.begin() + seconds / 3);
  EXPECT_LT(memory.back(), third + 2) << "MB; after a third of the time it was " << third;
}

/// The report says so: with a gravity of 300 m/s^2 soft bodies go on as always, as long as they cannot gain
/// speed by a fall.
TEST(Soak, AGravityOf300Holds) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run some seconds of the arena";
  Simulation3d simulation(arena(), {});
  using Event = InputEvent<3>;
  simulation.step(std::vector<Event>{{.action = Action::kTilt, .value = {0, 0, 0}}});
  for (int frame = 0; frame < 3 * kFramesASecond; ++frame) simulation.step();  // all lies on the floor
  simulation.step(std::vector<Event>{{.action = Action::kGravity, .value = {0, -300, 0}}});
  for (int frame = 0; frame < 10 * kFramesASecond; ++frame) {
    simulation.step();
    ASSERT_NO_FATAL_FAILURE(expect_surfaces_above_the_floor(simulation)) << "frame " << frame;
  }
  simulation.step(std::vector<Event>{{.action = Action::kGravity, .value = {0, -9.81f, 0}}});
  for (int frame = 0; frame < 5 * kFramesASecond; ++frame) simulation.step();
  ASSERT_NO_FATAL_FAILURE(expect_nothing_lost(simulation));
  // ... and have their shapes again, but for what their own weight does to them.
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    const ppu::SoftBody<3>& body = simulation.soft_body(b);
    const double size = radius_of_gyration(body, [&](std::size_t i) { return body.position(i); });
    const double at_rest =
        radius_of_gyration(body, [&](std::size_t i) { return body.model().lattice().rest_position(i); });
    EXPECT_NEAR(size / at_rest, 1, 0.1) << arena().soft_bodies[b].name;
  }
}

}  // namespace
}  // namespace softcell::demos
