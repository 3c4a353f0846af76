// What is inside of a mesh of several parts, against formulas; and that contacts see no surface there.

#include "ppu/mesh/solid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "mesh_checks.h"
#include "ppu/mesh/outer_surface.h"
#include "ppu/surfaces/contact_surface.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

TriangleMesh moved(TriangleMesh mesh, const Vector3f& by) {
  for (Vector3f& position : mesh.positions) position += by;
  return mesh;
}

TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh both(TriangleMesh mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

float area(const TriangleMesh& mesh) {
  float sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).norm() / 2;
  return sum;
}

/// Two balls that reach into each other, and how far a point is from what they are together.
struct TwoBalls {
  Vector3f second{1.2f, 0.1f, 0};
  TriangleMesh mesh = both(make_sphere(1, 24), moved(make_sphere(0.7f, 24), second));

  /// Outside, and inside near the surface of one ball alone.
  float distance(const Vector3f& point) const {
    return std::min(point.norm() - 1, (point - second).norm() - 0.7f);
  }
};

TEST(Solid, HasWhatIsInOneOfItsParts) {
  const TwoBalls balls;
  const Solid solid(balls.mesh);
  EXPECT_TRUE(solid.is_whole());
  std::mt19937 engine{3};
  std::uniform_real_distribution<float> coordinate(-2, 2);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3f point(coordinate(engine), coordinate(engine), coordinate(engine));
    const float distance = balls.distance(point);
    if (std::abs(distance) < 0.01f) continue;
    EXPECT_EQ(solid.contains(point), distance < 0) << point.transpose();
    inside += distance < 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 200);
}

/// Lines from these points run through corners, along edges and in the planes of triangles.
TEST(Solid, KnowsPointsBesideCornersAndEdges) {
  const Solid solid(make_box({2, 2, 2}, 0.5f));
  for (float x = -1.25f; x < 1.5f; x += 0.5f)
    for (float y = -1.5f; y < 1.6f; y += 0.25f)
      for (float z = -1.5f; z < 1.6f; z += 0.25f) {
        if (std::abs(y) == 1 || std::abs(z) == 1) continue;
        EXPECT_EQ(solid.contains({x, y, z}), std::abs(x) < 1 && std::abs(y) < 1 && std::abs(z) < 1)
            << x << " " << y << " " << z;
      }
}

TEST(Solid, ACavityIsOutside) {
  const Solid solid(both(make_sphere(1, 16), turned_inside_out(make_sphere(0.5f, 16))));
  EXPECT_FALSE(solid.contains({0.1f, 0, 0}));
  EXPECT_TRUE(solid.contains({0.7f, 0, 0}));
  EXPECT_FALSE(solid.contains({1.1f, 0, 0}));
}

TEST(Solid, IsWholeButForALittle) {
  TriangleMesh open = make_sphere(1, 8);
  open.triangles.pop_back();
  EXPECT_FALSE(Solid(open).is_whole());
  const TriangleMesh patch = both(make_sphere(1, 8), moved(open, {0, 3, 0}));
  EXPECT_FALSE(Solid(patch).is_whole());
  TriangleMesh small = open;
  for (Vector3f& position : small.positions) position *= 0.1f;
  const Solid solid(both(make_sphere(1, 8), moved(small, {0, 3, 0})));
  EXPECT_TRUE(solid.is_whole());
  EXPECT_TRUE(solid.contains({0, 0, 0}));
  EXPECT_FALSE(solid.contains({0, 3, 0}));
}

TEST(OuterSurface, OfOnePartIsTheMeshItself) {
  for (const TriangleMesh& mesh :
       {make_sphere(1, 12), make_box({1, 2, 3}, 0.4f), make_torus(1, 0.3f, 24, 12), make_vase(1, 24),
        turned_inside_out(make_sphere(1, 12)), make_cone(0.5f, 1, 24),
        both(make_sphere(1, 16), turned_inside_out(make_sphere(0.5f, 16)))})
    EXPECT_EQ(outer_surface(mesh, Solid(mesh), 0.2f), std::nullopt);
}

TEST(OuterSurface, OfAnOpenMeshIsTheMeshItself) {
  TriangleMesh mesh = both(make_sphere(1, 8), make_sphere(0.5f, 8));
  mesh.triangles.pop_back();
  EXPECT_EQ(outer_surface(mesh, Solid(mesh), 0.2f), std::nullopt);
}

/// A bar through a box: of the bar what sticks out on both sides is left, and of the box its sides with two holes.
TEST(OuterSurface, LeavesOutWhatIsWithinOtherParts) {
  for (const float step : {3.0f, 0.25f}) {
    const TriangleMesh mesh = both(make_box({2, 2, 2}, step), make_box({1, 1, 3}, step));
    const Solid solid(mesh);
    const TriangleMesh surface = outer_surface(mesh, solid, 0.2f).value();
    constexpr float kUnion = 24 + (2 * 1 + 4 * 3) - 4 * 2 - 2 * 1;
    EXPECT_NEAR(area(surface), kUnion, 0.02f * kUnion) << step;
    for (const auto& [a, b, c] : surface.triangles) {
      const Vector3f middle = (surface.positions[a] + surface.positions[b] + surface.positions[c]) / 3;
      const Vector3f depth = Vector3f(0.5f, 0.5f, 1.5f) - middle.cwiseAbs();
      const Vector3f depth_in_box = Vector3f(1, 1, 1) - middle.cwiseAbs();
      EXPECT_LT(depth.minCoeff(), 0.03f) << middle.transpose();
      EXPECT_LT(depth_in_box.minCoeff(), 0.03f) << middle.transpose();
    }
  }
}

/// Once a wing's end in its body was a surface there, with an outside of its own, and others sank in as far as that.
TEST(ContactSurface, HasNoSurfaceWithinABodyOfSeveralParts) {
  const TwoBalls balls;
  const Lattice<3> lattice = voxelize(balls.mesh, 0.2f);
  const ContactSurface surface(balls.mesh, lattice);
  int inside = 0;
  for (std::uint32_t cell = 0; cell < lattice.cells.size(); ++cell)
    for (std::size_t n = 0; n < ContactSurface::kNodes; ++n) {
      const Vector3f at(static_cast<float>(n % 3), static_cast<float>(n / 3 % 3), static_cast<float>(n / 9));
      const Vector3f node =
          lattice.origin + lattice.spacing * (lattice.cells[cell].cast<float>() + 0.5f * at);
      const float distance = balls.distance(node) / lattice.spacing, field = surface.nodes(cell)[n];
      // Where the balls meet, what is nearest is the edge between them.
      if (distance > 0 && distance < 1) {
        EXPECT_NEAR(field, distance, 0.05f) << node.transpose();
      }
      if (distance < -0.05f) {
        EXPECT_LT(field, 0.3f * distance) << node.transpose();
      }
      inside += distance < 0 ? 1 : 0;
    }
  EXPECT_GT(inside, 1000);
  for (const SurfacePointAtRest& point : surface.points())
    EXPECT_NEAR(balls.distance(point.rest) / lattice.spacing, 0, 0.15f) << point.rest.transpose();
}

TEST(ContactSurface, OfAPenguinHasAnInsideWithoutHoles) {
  const TriangleMesh mesh = make_penguin(1);
  const Solid solid(mesh);
  ASSERT_TRUE(solid.is_whole());
  const Lattice<3> lattice = voxelize(mesh, 0.12f);
  const ContactSurface surface(mesh, lattice);
  for (std::uint32_t cell = 0; cell < lattice.cells.size(); ++cell)
    for (std::size_t n = 0; n < ContactSurface::kNodes; ++n) {
      const Vector3f at(static_cast<float>(n % 3), static_cast<float>(n / 3 % 3), static_cast<float>(n / 9));
      const Vector3f node =
          lattice.origin + lattice.spacing * (lattice.cells[cell].cast<float>() + 0.5f * at);
      const float sign = solid.contains(node) ? -1.0f : 1.0f;
      EXPECT_GE(sign * surface.nodes(cell)[n], 0) << node.transpose();
    }
}

}  // namespace
}  // namespace softcell::ppu
