// Scene arena for a long time: no body gets lost, no number goes bad, no memory is lost. ci/soak runs it for
// 10,000 simulated seconds.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "scene_file/scene_library.h"
#include "simulation_3d.h"

namespace softcell::demos {
namespace {

constexpr int kFramesASecond = 60;

// A sanitizer keeps freed memory for a while, so that there is nothing to be learnt from its amount.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryIsMeasured = false;
#else
constexpr bool kMemoryIsMeasured = true;
#endif

/// Of this process, resident, in megabytes.
double memory_in_use() {
  std::ifstream file("/proc/self/statm");
  double program = 0, resident = 0;
  file >> program >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

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

void expect_nothing_lost(const Simulation3d& simulation) {
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    const ppu::SoftBody& body = simulation.soft_body(b);
    const std::string& name = arena().soft_bodies[b].name;
    for (std::size_t i = 0; i < body.model().particles(); ++i) {
      const Eigen::Vector3f x = body.position(i);
      ASSERT_TRUE(x.allFinite() && body.velocities()[i].allFinite()) << name;
      ASSERT_TRUE(x.y() > 0 || !between_walls(x)) << name << " is in the floor: " << x.transpose();
    }
    const Eigen::Vector3f middle = body.centre_of_mass();
    ASSERT_TRUE(between_walls(middle) && middle.y() < 10) << name << " is at " << middle.transpose();
  }
  for (const Eigen::Matrix4f& pose : simulation.shown_box_poses())
    ASSERT_TRUE(pose.allFinite() && pose(1, 3) > -0.6f) << pose;
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

}  // namespace
}  // namespace softcell::demos
