// Finer triangles for coarse meshes.
#include "softcell/soft_bodies/tessellate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "fracture/fracture_checks.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/skinned_mesh.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector4f;

double surface_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d p = mesh.positions[a].cast<double>();
    sum += (mesh.positions[b].cast<double>() - p).cross(mesh.positions[c].cast<double>() - p).norm() / 2;
  }
  return sum;
}

float longest_edge_of(const TriangleMesh& mesh) {
  float longest = 0;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest =
          std::max(longest, (mesh.positions[triangle[k]] - mesh.positions[triangle[(k + 1) % 3]]).norm());
  return longest;
}

struct RefinedShape {
  std::string name;
  TriangleMesh mesh;
};
std::vector<RefinedShape> coarse_shapes() {
  return {{"beam", make_box({2, 0.2f, 0.3f}, 10)}, {"cube", make_box({1, 1, 1}, 10)},
          {"sphere", make_sphere(0.5f, 1)},        {"torus", make_torus(0.5f, 0.2f, 6, 4)},
          {"cone", make_cone(0.4f, 2, 7)},         {"car", make_car(1)}};
}

TEST(Tessellate, KeepsMeshesClosedWithTheirSurfaceAndVolume) {
  for (const auto& [name, mesh] : coarse_shapes())
    for (const float longest : {0.31f, 0.1f, 0.037f}) {
      SCOPED_TRACE(name + " to " + std::to_string(longest));
      const TriangleMesh finer = tessellate(mesh, longest);
      validate(finer);
      ASSERT_EQ(unmet_sides(mesh), 0u);
      EXPECT_EQ(unmet_sides(finer), 0u) << "an edge ends in the middle of another one";
      EXPECT_LE(longest_edge_of(finer), longest);
      EXPECT_NEAR(surface_of(finer), surface_of(mesh), 1e-6 * surface_of(mesh));
      EXPECT_NEAR(volume(finer), volume(mesh), 1e-6 * std::abs(volume(mesh)));
      for (const Vector3f& normal : finer.normals) EXPECT_NEAR(normal.norm(), 1, 1e-5f);
    }
}

TEST(Tessellate, LeavesTheUsersVerticesAsTheyAreInFront) {
  for (const auto& [name, mesh] : coarse_shapes()) {
    SCOPED_TRACE(name);
    const TriangleMesh finer = tessellate(mesh, 0.03f);
    ASSERT_GT(finer.positions.size(), mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      EXPECT_EQ(finer.positions[v], mesh.positions[v]);
      EXPECT_EQ(finer.normals[v], mesh.normals[v]);
    }
    EXPECT_EQ(tessellate(mesh, 100), mesh) << "nothing is too long";
    EXPECT_EQ(tessellate(mesh, 0.03f), finer) << "the same again";
    EXPECT_EQ(tessellate(finer, 0.03f), finer) << "it is done";
  }
}

/// Texture coordinates and colours that are linear in the position stay so; triangles keep their material.
TEST(Tessellate, CarriesAttributesAndMaterialsAlong) {
  TriangleMesh mesh = make_box({2, 0.2f, 0.3f}, 10);
  const auto coordinates_at = [](const Vector3f& at) { return Vector2f(at.x() + 2 * at.z(), 3 - at.y()); };
  const auto colour_at = [](const Vector3f& at) {
    return Vector4f(0.5f + 0.2f * at.x(), at.y() + 0.5f, 0.3f, 1);
  };
  for (const Vector3f& at : mesh.positions) {
    mesh.texture_coordinates.push_back(coordinates_at(at));
    mesh.colours.push_back(colour_at(at));
  }
  mesh.materials.resize(2);
  mesh.materials[0].name = "paint", mesh.materials[1].name = "rust";
  // The last part is empty.
  mesh.parts = {{.object = "front", .material = 0, .first_triangle = 0, .triangle_count = 5},
                {.object = "back", .material = 1, .first_triangle = 5, .triangle_count = 7},
                {.object = "none", .material = 1, .first_triangle = 12, .triangle_count = 0}};
  ASSERT_EQ(mesh.triangles.size(), 12u);
  const TriangleMesh finer = tessellate(mesh, 0.15f);
  validate(finer);
  ASSERT_EQ(finer.parts.size(), 3u);
  EXPECT_EQ(finer.materials, mesh.materials);
  for (std::size_t v = 0; v < finer.positions.size(); ++v) {
    EXPECT_LT((finer.texture_coordinates[v] - coordinates_at(finer.positions[v])).norm(), 1e-6f);
    EXPECT_LT((finer.colours[v] - colour_at(finer.positions[v])).norm(), 1e-6f);
  }
  const auto part_surface = [](const TriangleMesh& of, const MeshPart& part) {
    TriangleMesh only = of;
    only.parts.clear();
    only.triangles.assign(of.triangles.begin() + part.first_triangle,
                          of.triangles.begin() + part.first_triangle + part.triangle_count);
    return surface_of(only);
  };
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_EQ(finer.parts[p].object, mesh.parts[p].object);
    EXPECT_EQ(finer.parts[p].material, mesh.parts[p].material);
    EXPECT_NEAR(part_surface(finer, finer.parts[p]), part_surface(mesh, mesh.parts[p]), 1e-6);
  }
}

/// A beam of twelve triangles is bent to an arc of a radius of two lengths. Its long edges are straight lines; those of the tessellated one follow.
TEST(Tessellate, ABeamOfLongTrianglesFollowsItsLattice) {
  constexpr float kRadius = 4, kLength = 2;
  const TriangleMesh coarse = make_box({kLength, 0.2f, 0.3f}, 10);
  const SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1};
  const auto off_by = [&](const TriangleMesh& mesh) {
    SoftBody<3> body(make_soft_body_model(mesh, settings));
    const auto bent = [](const Vector3f& at) {
      const float angle = at.x() / kRadius, r = kRadius + at.y();
      return Vector3f(r * std::sin(angle), r * std::cos(angle) - kRadius, at.z());
    };
    for (std::size_t i = 0; i < body.positions().size(); ++i)
      body.set_particle(i, bent(body.position(i)), Vector3f::Zero());
    TriangleMesh drawn = mesh;
    skin(body, drawn.positions, drawn.normals);
    // How far the middles of edges are from where the material there is.
    float most = 0;
    for (const auto& triangle : drawn.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
        const Vector3f wanted = bent(0.5f * (mesh.positions[a] + mesh.positions[b]));
        most = std::max(most, (0.5f * (drawn.positions[a] + drawn.positions[b]) - wanted).norm());
      }
    return most;
  };
  const float before = off_by(coarse), after = off_by(tessellate(coarse, settings.cell_size));
  EXPECT_GT(before, 0.9f * kLength * kLength / (8 * kRadius)) << "the height of the arc over its chord";
  EXPECT_LT(after, before / 100);
}

TEST(Tessellate, RefusesWhatCannotBe) {
  const TriangleMesh mesh = make_box({2, 0.2f, 0.3f}, 10);
  for (const float longest : {0.0f, -1.0f, std::nanf(""), std::numeric_limits<float>::infinity()})
    EXPECT_THROW(tessellate(mesh, longest), std::invalid_argument);
  try {
    tessellate(mesh, -1e-9f);
    ADD_FAILURE() << "it was tessellated";
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "a mesh is tessellated to edges of -1e-09 m; give a length above 0");
  }
  EXPECT_THROW(tessellate(mesh, 1e-6f), std::invalid_argument) << "more triangles than anybody needs";
  TriangleMesh wrong = mesh;
  wrong.normals.pop_back();
  EXPECT_THROW(tessellate(wrong, 0.1f), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::ppu
