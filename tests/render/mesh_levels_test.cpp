// Coarser versions of meshes: no holes, no sides that run into each other, and as near to the surface as they say.

#include "mesh_levels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "../support/contract.h"

namespace softcell::render {
namespace {

using Eigen::Vector3f;

struct Mesh {
  std::vector<Vector3f> positions, normals;
  std::vector<Triangle> triangles;

  void add_face(const Vector3f& corner, const Vector3f& u, const Vector3f& v, std::uint32_t cells) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    const auto step = 1 / static_cast<float>(cells);
    for (std::uint32_t j = 0; j <= cells; ++j) {
      for (std::uint32_t i = 0; i <= cells; ++i) {
        const Vector3f at = corner + static_cast<float>(i) * step * u + static_cast<float>(j) * step * v;
        positions.push_back((at * 4096).array().round() / 4096 +
                            0.0f);  // the same on both sides of a crease; no -0
        normals.push_back(u.cross(v).normalized());
      }
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
      for (std::uint32_t i = 0; i < cells; ++i) {
        const std::uint32_t a = first + j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
        triangles.push_back({a, b, d});
        triangles.push_back({a, d, c});
      }
    }
  }
};

/// A box with creases: each face has vertices of its own.
Mesh box(const Vector3f& size, std::uint32_t cells) {
  const Vector3f x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z()), low = -0.5f * size,
                                                                          high = 0.5f * size;
  Mesh mesh;
  mesh.add_face(low, y, x, cells);
  mesh.add_face(low, z, y, cells);
  mesh.add_face(low, x, z, cells);
  mesh.add_face(high, -x, -y, cells);
  mesh.add_face(high, -y, -z, cells);
  mesh.add_face(high, -z, -x, cells);
  return mesh;
}

Mesh sphere(float radius, std::uint32_t cells) {
  Mesh mesh = box({2, 2, 2}, cells);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.normals[i] = mesh.positions[i].normalized();
    mesh.positions[i] = radius * mesh.normals[i];
  }
  return mesh;
}

/// How often each edge between two places is gone along in one direction more than in the other: 0 where a surface is closed.
int open_edges(const Mesh& mesh, const std::vector<Triangle>& triangles) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, int> edges;
  const auto place = [&](std::uint32_t v) {
    const Vector3f& p = mesh.positions[v];
    return Place{p.x(), p.y(), p.z()};
  };
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Place a = place(t[k]), b = place(t[(k + 1) % 3]);
      if (a < b) ++edges[{a, b}];
      if (b < a) --edges[{b, a}];
    }
  }
  return static_cast<int>(std::ranges::count_if(edges, [](const auto& edge) { return edge.second != 0; }));
}

TEST(MeshLevels, AClosedSurfaceStaysClosed) {
  for (const Mesh& mesh : {box({1, 0.7f, 0.4f}, 12), box({1, 1, 0.02f}, 20), sphere(1, 20)}) {
    ASSERT_EQ(open_edges(mesh, mesh.triangles), 0);
    for (const float spacing : {0.03f, 0.1f, 0.17f, 0.3f, 0.6f}) {
      const MeshLevel level = coarser(mesh.positions, mesh.normals, mesh.triangles, spacing);
      EXPECT_EQ(open_edges(mesh, level.triangles), 0) << spacing;
    }
  }
}

TEST(MeshLevels, TheFacesOfAThinPlateKeepTheirSides) {
  const Mesh plate = box({1, 1, 0.02f}, 20);
  const MeshLevel level = coarser(plate.positions, plate.normals, plate.triangles, 0.15f);
  EXPECT_LT(level.triangles.size(), plate.triangles.size() / 4);
  float area = 0;
  for (const Triangle& t : level.triangles) {
    const Vector3f a = plate.positions[t[0]], b = plate.positions[t[1]], c = plate.positions[t[2]];
    const Vector3f across = (b - a).cross(c - a);
    area += 0.5f * across.norm();
    for (const std::uint32_t v : t)
      EXPECT_GE(plate.normals[v].dot(across), -1e-6f) << "a vertex of another face";
  }
  EXPECT_NEAR(area, 2 + 4 * 0.02f, 0.02f) << "both sides and no more";
  EXPECT_NEAR(level.error, 0, 0.005f) << "planes are not left";
  EXPECT_GT(level.spacing, 0.05f);
}

TEST(MeshLevels, SayHowFarTheyLeaveASphere) {
  constexpr float kRadius = 2;
  const Mesh ball = sphere(kRadius, 40);
  for (const float spacing : {0.2f, 0.4f}) {
    const MeshLevel level = coarser(ball.positions, ball.normals, ball.triangles, spacing);
    EXPECT_LE(level.spacing, 1.75f * spacing) << "the diagonal of a cube";
    // Moved by d along a sphere, a vertex is d^2 / 2R below the plane that touched it.
    EXPECT_LE(level.error, level.spacing * level.spacing / (2 * kRadius));
    EXPECT_GE(level.error, 0.02f * spacing * spacing / (2 * kRadius));
    for (const Triangle& t : level.triangles)
      for (const std::uint32_t v : t) ASSERT_LT(v, ball.positions.size());
  }
}

TEST(MeshLevels, HaveFewerAndFewerTriangles) {
  const Mesh ball = sphere(1, 40);
  const std::vector<MeshLevel> levels = coarser_levels(ball.positions, ball.normals, ball.triangles);
  ASSERT_GE(levels.size(), 3u);
  std::size_t before = ball.triangles.size();
  for (const MeshLevel& level : levels) {
    EXPECT_LE(static_cast<double>(level.triangles.size()), 0.7 * static_cast<double>(before));
    before = level.triangles.size();
  }
  EXPECT_LT(before, 600u);
  EXPECT_LT(levels.front().error, levels.back().error);
}

TEST(MeshLevels, SmallAndSpoiltMeshesHaveNone) {
  const Mesh cube = box({1, 1, 1}, 3);
  EXPECT_TRUE(coarser_levels(cube.positions, cube.normals, cube.triangles).empty());
  Mesh spoilt = sphere(1, 20);
  spoilt.positions[7].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(coarser_levels(spoilt.positions, spoilt.normals, spoilt.triangles).empty());
  Mesh point = sphere(1, 20);
  for (Vector3f& position : point.positions) position.setZero();
  EXPECT_TRUE(coarser_levels(point.positions, point.normals, point.triangles).empty());
}

TEST(MeshLevelsDeathTest, AreAskedForWithASpacing) {
  const Mesh cube = box({1, 1, 1}, 3);
  SC_EXPECT_VIOLATES(coarser(cube.positions, cube.normals, cube.triangles, 0),
                     "vertices 0 m apart are joined");
}

}  // namespace
}  // namespace softcell::render
