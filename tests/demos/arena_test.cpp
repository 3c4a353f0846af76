// Scene arena frame by frame, against the oracle and the promises of the design.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "ppu/reference/skin_scalar.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "support/float_from_half.h"
#include "support/slow_build.h"

namespace softcell::demos {
namespace {

/// So deep, in cells, a hard landing presses what is drawn into the floor, which pushes it out within a second.
constexpr float kDeepestInCells = 0.15f;

const Scene& arena() {
  static const Scene scene = load_scene_3d("arena");
  return scene;
}

/// Distance between neighbouring binary16 numbers at this magnitude.
double half_ulp_at(double value) {
  const int exponent = std::max(std::ilogb(std::max(std::abs(value), 1e-30)), -14);
  return std::ldexp(1.0, exponent - 10);
}

struct WorstVertex {
  double position_ulps = 0;
  double normal_radians = 0;
};

/// The box around what is drawn in the shown frame.
Eigen::AlignedBox3f box_of(const ppu::SkinnedBody& body) {
  Eigen::AlignedBox3f box;
  for (const spu::SkinnedVertex& vertex : body.vertices) {
    Eigen::Vector3f position = body.origin;
    for (int d = 0; d < 3; ++d) position[d] += ppu::float_from_half(vertex.position[d]);
    box.extend(position);
  }
  return box;
}

/// Compares every vertex of the shown frame with a double-precision evaluation of the same particles.
WorstVertex compare_with_oracle(const Simulation3d& simulation) {
  WorstVertex worst;
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    const ppu::Embedding& embedding = simulation.model(b).embedding();
    const ppu::SkinnedBody body = simulation.shown(b);
    std::vector<Eigen::Vector3f> particles;
    for (const Eigen::Vector4f& p : simulation.shown_particles(b)) particles.emplace_back(p.head<3>());
    for (const ppu::SkinPart& part : embedding.parts) {
      for (std::uint32_t group = part.first_group; group < part.first_group + part.group_count; ++group) {
        for (int lane = 0; lane < 4; ++lane) {
          const ppu::ReferenceVertex expected =
              ppu::evaluate_reference(embedding, part, group, lane, particles);
          const spu::SkinnedVertex& actual = body.vertices[4 * group + static_cast<std::uint32_t>(lane)];
          Eigen::Vector3d normal;
          for (int axis = 0; axis < 3; ++axis) {
            const double relative = expected.position[axis] - double{body.origin[axis]};
            const double position = ppu::float_from_half(actual.position[axis]);
            worst.position_ulps =
                std::max(worst.position_ulps, std::abs(position - relative) / half_ulp_at(relative));
            normal[axis] = ppu::float_from_half(actual.normal[axis]);
          }
          const double angle = std::atan2(normal.cross(expected.normal).norm(), normal.dot(expected.normal));
          worst.normal_radians = std::max(worst.normal_radians, angle);
        }
      }
    }
  }
  return worst;
}

TEST(Arena, EveryVertexOfEveryFrameAgreesWithTheOracle) {
  Simulation3d simulation(arena(), {});
  for (int frame = 0; frame < (kSlowBuild ? 20 : 120); ++frame) {
    simulation.step();
    const WorstVertex worst = compare_with_oracle(simulation);
    ASSERT_LE(worst.position_ulps, 1.0) << "frame " << frame;
    ASSERT_LE(worst.normal_radians, 0.01) << "frame " << frame;
  }
}

TEST(Arena, HoldsWhatTheIssueAsksOfIt) {
  Simulation3d simulation(arena(), {});
  EXPECT_GE(simulation.soft_bodies(), 4u);
  EXPECT_GE(simulation.rigid_bodies(), 4u);
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    EXPECT_GE(simulation.model(b).lattice().particles.size(), 100u) << arena().soft_bodies[b].name;
    EXPECT_LE(simulation.model(b).lattice().particles.size(), 1000u) << arena().soft_bodies[b].name;
  }
}

TEST(Arena, NothingLeavesThroughFloorOrWallsAndEverythingStaysFinite) {
  Simulation3d simulation(arena(), {});
  for (int frame = 0; frame < (kSlowBuild ? 90 : 480); ++frame) {
    simulation.step();
    for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
      for (const Eigen::Vector4f& p : simulation.shown_particles(b)) ASSERT_TRUE(p.allFinite());
      // What is drawn; particles of its cells may be farther out.
      const Eigen::AlignedBox3f box = box_of(simulation.shown(b));
      const float deepest = kDeepestInCells * simulation.model(b).settings().cell_size;
      const std::string& name = arena().soft_bodies[b].name;
      ASSERT_GT(box.min().y(), -deepest) << name << " is under the floor in frame " << frame;
      const float farthest = std::max({-box.min().x(), -box.min().z(), box.max().x(), box.max().z()});
      ASSERT_LT(farthest, 4.8f + deepest) << name << " left in frame " << frame;
    }
    for (const Eigen::Matrix4f& pose : simulation.shown_box_poses()) ASSERT_GT(pose(1, 3), -0.6f);
  }
}

TEST(Arena, TheAntennaOfTheCarBends) {
  Simulation3d simulation(arena(), {});
  const auto car =
      static_cast<std::size_t>(std::find_if(arena().soft_bodies.begin(), arena().soft_bodies.end(),
                                            [](const auto& s) { return s.name == "car"; }) -
                               arena().soft_bodies.begin());
  ASSERT_LT(car, simulation.soft_bodies());
  const ppu::Lattice<3>& lattice = simulation.model(car).lattice();
  // The antenna is what is highest: its tip, its foot one half further down, and the body's middle.
  std::size_t tip = 0;
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    if (lattice.particles[i].y() > lattice.particles[tip].y()) tip = i;
  }
  const auto at = [&](std::size_t i) {
    return Eigen::Vector3f(simulation.shown_particles(car)[i].head<3>());
  };
  const auto below = [&](int cells) {
    const Eigen::Vector3i wanted = lattice.particles[tip] - Eigen::Vector3i(0, cells, 0);
    return static_cast<std::size_t>(std::find(lattice.particles.begin(), lattice.particles.end(), wanted) -
                                    lattice.particles.begin());
  };
  const std::size_t middle = below(2), foot = below(4);
  ASSERT_LT(middle, lattice.particles.size());
  ASSERT_LT(foot, lattice.particles.size());
  float largest = 0;
  for (int frame = 0; frame < 300; ++frame) {
    simulation.step();
    const Eigen::Vector3f lower = (at(middle) - at(foot)).normalized(),
                          upper = (at(tip) - at(middle)).normalized();
    largest = std::max(largest, lower.cross(upper).norm());
  }
  EXPECT_GT(largest, 0.1f) << "sine of the largest angle between the antenna's halves";
}

TEST(Arena, TheStateIsTheSameForAnyNumberOfSpesAndAnySchedule) {
  std::uint64_t expected = 0;
  for (const auto& [spes, schedule] :
       {std::pair{6, "eager"}, std::pair{1, "lazy"}, std::pair{4, "random:3"}}) {
    Simulation3d simulation(arena(), {.spes = spes, .schedule = dma::parse_schedule(schedule)});
    std::uint64_t pictures = 14695981039346656037u;
    for (int frame = 0; frame < 40; ++frame) {
      simulation.step();
      // The vertices are what the SPEs make: their bytes must be the same too.
      for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
        for (const std::byte byte : std::as_bytes(simulation.shown(b).vertices)) {
          pictures = (pictures ^ std::to_integer<std::uint64_t>(byte)) * 1099511628211u;
        }
      }
    }
    const std::uint64_t hash = simulation.state_hash() ^ std::rotl(pictures, 1);
    if (expected == 0) expected = hash;
    EXPECT_EQ(hash, expected) << spes << " SPEs, " << schedule;
  }
}

}  // namespace
}  // namespace softcell::demos
