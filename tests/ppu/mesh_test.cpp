// Meshes made from positions and triangles alone.

#include "softcell/soft_bodies/mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// The message of the exception of that type which make_mesh() throws.
template <class Exception>
std::string refusal(const std::vector<Vector3f>& positions, const Triangles& triangles) {
  try {
    make_mesh(positions, triangles);
  } catch (const Exception& error) {
    return error.what();
  }
  return "none";
}

TEST(MakeMesh, OfAShapesArraysIsTheShape) {
  for (const TriangleMesh& shape :
       {make_box({1, 2, 3}, 0.5f), make_cylinder(0.5f, 1, 16), make_vase(1, 24)}) {
    const TriangleMesh mesh = make_mesh(shape.positions, shape.triangles);
    validate(mesh);
    ASSERT_EQ(mesh.triangles.size(), shape.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t now = mesh.triangles[t][k], before = shape.triangles[t][k];
        EXPECT_EQ(mesh.positions[now], shape.positions[before]) << "triangle " << t;
        EXPECT_NEAR((mesh.normals[now] - shape.normals[before]).norm(), 0, 1e-6f) << "triangle " << t;
      }
    }
  }
}

TEST(MakeMesh, IsSmoothUpToSixtyDegreesAlsoWhereEachTriangleHasPositionsOfItsOwn) {
  // Two squares that meet at x = 0, as six positions each: the second one rises by some degrees.
  for (const float degrees : {59.0f, 61.0f}) {
    const float radians = degrees * std::acos(-1.0f) / 180;
    const Vector3f up(std::cos(radians), std::sin(radians), 0), deep(0, 0, -1);
    const Vector3f o(0, 0, 0), left(-1, 0, 0);
    const std::vector<Vector3f> positions{left, o,  o + deep,  left, o + deep,  left + deep,
                                          o,    up, up + deep, o,    up + deep, o + deep};
    const TriangleMesh mesh = make_mesh(positions, Triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}});
    EXPECT_EQ(mesh.positions.size(), degrees < 60 ? 6u : 8u) << degrees;
    EXPECT_NEAR((mesh.normals[mesh.triangles[0][0]] - Vector3f(0, 1, 0)).norm(), 0, 1e-6f) << degrees;
  }
}

TEST(MakeMesh, LeavesOutTrianglesWithoutAreaAndPositionsWithoutATriangle) {
  const std::vector<Vector3f> positions{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 0, 0}};
  const TriangleMesh mesh = make_mesh(positions, Triangles{{1, 4, 2}, {1, 2, 3}, {2, 2, 3}});
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh.positions, (std::vector<Vector3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vector3f>(3, {0, 0, 1})));
  EXPECT_TRUE(make_mesh({}, {}).triangles.empty());
}

TEST(MakeMesh, RefusesWhatIsNoMeshWithASentence) {
  EXPECT_EQ(refusal<std::invalid_argument>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}),
            "triangle 1 of a mesh names vertex 3; the mesh has 3");
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal<std::runtime_error>({{0, 0, 0}, {1, kNan, 0}, {0, 1, 0}}, {{0, 1, 2}}),
            "position 1 of a mesh is 1, nan, 0; finite coordinates were expected");
}

}  // namespace
}  // namespace softcell::ppu
