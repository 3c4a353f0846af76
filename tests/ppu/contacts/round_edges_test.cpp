// Which edges of what is round a body has to look up, against formulas.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ppu/obstacles/obstacle.h"
#include "ppu/obstacles/round_edges.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr float kPi = std::numbers::pi_v<float>;

/// A regular prism along y, or a pyramid with its tip at + y.
struct Prism {
  int sides;
  float radius, half_height;
  bool has_tip = false;

  Vector3f corner(int i, float height) const {
    const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(sides);
    return {radius * std::cos(angle), height, radius * std::sin(angle)};
  }
  ObstacleEdge side(int i) const {
    return {corner(i, -half_height), has_tip ? Vector3f(0, half_height, 0) : corner(i, half_height)};
  }
  ObstacleEdge rim(int i) const { return {corner(i, -half_height), corner(i + 1, -half_height)}; }
  std::vector<Vector4f> planes() const {
    std::vector<Vector4f> all{{0, -1, 0, half_height}};
    if (!has_tip) all.push_back({0, 1, 0, half_height});
    for (int i = 0; i < sides; ++i) {
      const Vector3f low = corner(i, -half_height), next = corner(i + 1, -half_height);
      const Vector3f normal = (side(i).to - low).cross(next - low).normalized();
      all.push_back({normal.x(), normal.y(), normal.z(), normal.dot(low)});
    }
    return all;
  }
};

/// A chord of 0.7 cells cuts off 0.7^2 cells^2 / (8 r) of a round thing of radius r: 0.06 cells if the cells are as large as the radius.
TEST(RoundEdges, OfAPrismOfManySidesAreFeltByBodiesWithCellsBelowItsRadius) {
  for (const float radius : {0.01f, 0.25f, 30.0f}) {
    for (const int sides : {48, 32, 24}) {
      const Prism prism{sides, radius, 2 * radius};
      const std::vector<Vector4f> planes = prism.planes();
      for (const int i : {0, 5}) {
        EXPECT_NEAR(cells_that_feel(prism.side(i), planes) / radius, 1.0f, 0.2f) << sides;
        EXPECT_EQ(cells_that_feel(prism.rim(i), planes), 0) << sides;
      }
    }
  }
}

TEST(RoundEdges, OfAPrismOfFewSidesAreSharp) {
  for (const int sides : {4, 6, 12}) {
    const Prism prism{sides, 0.3f, 0.5f};
    EXPECT_EQ(cells_that_feel(prism.side(1), prism.planes()), 0) << sides;
    std::vector<ObstacleEdge> edges;
    add_edges_of_hull(std::vector{prism.side(1)}, prism.planes(), edges);
    ASSERT_EQ(edges.size(), 1u);
    EXPECT_EQ(edges[0].cells_above, 0);
  }
}

/// Each half as far from the tip as the one before it, felt by half as large cells.
TEST(RoundEdges, OfAPyramidAreInPartsThatGetSharperTowardsTheTip) {
  for (const bool turned : {false, true}) {
    const Prism pyramid{32, 0.45f, 0.75f, true};
    const std::vector<Vector4f> planes = pyramid.planes();
    ObstacleEdge side = pyramid.side(3);
    if (turned) std::swap(side.from, side.to);
    std::vector<ObstacleEdge> edges;
    add_edges_of_hull(std::vector{side}, planes, edges);
    ASSERT_EQ(edges.size(), 5u);
    float length = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      length += (edges[i].to - edges[i].from).norm();
      const float thin = 0.5f * 0.45f / static_cast<float>(1u << i);
      if (i + 1 < edges.size()) {
        EXPECT_NEAR(edges[i].cells_above / thin, 1.0f, 0.25f) << i;
      }
    }
    EXPECT_EQ(edges.back().cells_above, 0);
    EXPECT_NEAR(length, (side.to - side.from).norm(), 1e-5f);
  }
}

/// In the frame in which something first touches such a hull, it may take a few milliseconds.
TEST(RoundEdges, OfAHullOfThousandsOfFacesAreAsTheyAre) {
  const Prism prism{2000, 0.3f, 0.5f};
  std::vector<ObstacleEdge> sides, edges;
  for (int i = 0; i < prism.sides; ++i) sides.push_back(prism.side(i));
  add_edges_of_hull(sides, prism.planes(), edges);
  ASSERT_EQ(edges.size(), sides.size());
  for (const ObstacleEdge& edge : edges) EXPECT_EQ(edge.cells_above, 0);
}

TEST(RoundEdges, ACylindersAxisIsThatOfBallsWithin) {
  std::vector<ObstacleEdge> edges;
  add_axis_of_cylinder(0.3f, 0.2f, edges);
  EXPECT_TRUE(edges.empty()) << "no ball of its radius is within a disc";
  add_axis_of_cylinder(0.3f, 0.5f, edges);
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_TRUE(edges[0].from.isApprox(Vector3f(0, -0.2f, 0)));
  EXPECT_TRUE(edges[0].to.isApprox(Vector3f(0, 0.2f, 0)));
  EXPECT_FLOAT_EQ(edges[0].radius_at(0.7f), 0.3f);
  EXPECT_FLOAT_EQ(edges[0].cells_above, 0.3f);
}

TEST(RoundEdges, AConesAxisIsThatOfBallsWithinUpToItsTip) {
  std::vector<ObstacleEdge> edges;
  Obstacle cone;
  cone.kind = ObstacleKind::kCone;
  cone.extent = {0.4f, 0.6f, 0};
  add_axis_of_cone(cone.extent.x(), cone.extent.y(), edges);
  ASSERT_FALSE(edges.empty());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0) {
      EXPECT_EQ(edges[i].from, edges[i - 1].to) << i;
    }
    EXPECT_LE(edges[i].cells_above, edges[i].radius_to) << i;
    for (const float share : {0.0f, 0.4f, 1.0f}) {
      const Vector3f middle = edges[i].from + share * (edges[i].to - edges[i].from);
      EXPECT_NEAR(separation(cone, middle).distance, -edges[i].radius_at(share), 1e-5f) << i;
    }
  }
  EXPECT_TRUE(edges.back().to.isApprox(Vector3f(0, 0.6f, 0)));
  EXPECT_EQ(edges.back().radius_to, 0);
}

}  // namespace
}  // namespace softcell::ppu
