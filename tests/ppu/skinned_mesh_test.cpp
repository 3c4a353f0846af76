// The drawn surface of a body as floats.

#include "softcell/soft_bodies/skinned_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>
#include <stdexcept>
#include <vector>

#include "ppu/lattice/embedding.h"
#include "ppu/reference/skin_scalar.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

std::shared_ptr<const SoftBodyModel<3>> penguin() {
  TriangleMesh mesh = make_penguin(1);
  for (const Vector3f& p : mesh.positions) mesh.texture_coordinates.emplace_back(p.x(), p.y());
  mesh.parts = {{.object = "penguin",
                 .material = {},
                 .first_triangle = 0,
                 .triangle_count = static_cast<std::uint32_t>(mesh.triangles.size())}};
  return make_soft_body_model(mesh, {.cell_size = 0.15f});
}

/// Every particle a little elsewhere.
void shake(SoftBody<3>& body) {
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    const auto n = static_cast<float>(i % 7);
    body.set_particle(i, body.position(i) + Vector3f(0.003f * n, 0.002f * (3 - n), 0.001f * n), {0, 0, 0});
  }
}

TEST(SkinnedMesh, AtRestItIsTheMeshAsGiven) {
  const auto model = penguin();
  const TriangleMesh& mesh = model->mesh();
  EXPECT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
  EXPECT_EQ(mesh.parts.size(), 1u);
  SkinnedMesh skin(model);
  EXPECT_EQ(skin.mesh(), mesh);
  const Vector3f at(1, 2, 3);
  skin.update(SoftBody<3>(model, at));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    ASSERT_LT((skin.positions()[v] - at - mesh.positions[v]).norm(), 1e-6f) << v;
    ASSERT_LT((skin.normals()[v] - mesh.normals[v]).norm(), 1e-5f) << v;
  }
}

TEST(SkinnedMesh, TurnsWithTheBody) {
  const auto model = penguin();
  SoftBody<3> body(model);
  const Eigen::Quaternionf turn(Eigen::AngleAxisf(0.7f, Vector3f(1, 2, 3).normalized()));
  const Vector3f centre = body.centre_of_mass();
  body.move_without_force(turn, {0, 1, 0});
  SkinnedMesh skin(model);
  skin.update(body);
  for (std::size_t v = 0; v < skin.positions().size(); ++v) {
    const Vector3f expected = turn * (model->mesh().positions[v] - centre) + centre + Vector3f(0, 1, 0);
    ASSERT_LT((skin.positions()[v] - expected).norm(), 2e-6f) << v;
    ASSERT_LT((skin.normals()[v] - turn * model->mesh().normals[v]).norm(), 2e-5f) << v;
  }
}

TEST(SkinnedMesh, IsTheOraclesWhenDeformed) {
  const auto model = penguin();
  SoftBody<3> body(model);
  shake(body);
  SkinnedMesh skin(model);
  skin.update(body);
  const Embedding& embedding = model->embedding();
  for (const SkinPart& part : embedding.parts) {
    for (std::uint32_t g = part.first_group; g < part.first_group + part.group_count; ++g) {
      for (int lane = 0; lane < 4; ++lane) {
        const ReferenceVertex exact = evaluate_reference(embedding, part, g, lane, body.positions());
        const std::uint32_t vertex = embedding.vertex_of_slot[4 * g + static_cast<std::uint32_t>(lane)];
        ASSERT_LT((skin.positions()[vertex].cast<double>() - exact.position).norm(), 1e-6) << vertex;
        ASSERT_LT((skin.normals()[vertex].cast<double>() - exact.normal).norm(), 2e-5) << vertex;
      }
    }
  }
}

TEST(SkinnedMesh, RefusesAnotherModelsBodyAndWrongSizes) {
  SkinnedMesh skin_of_one(penguin());
  const SoftBody<3> other(penguin());
  EXPECT_THROW(skin_of_one.update(other), std::invalid_argument);
  std::vector<Vector3f> few(3);
  EXPECT_THROW(skin(other, few, few), std::invalid_argument);
}

TEST(SkinnedMesh, AModelWithoutAMeshHasNoVertices) {
  const std::vector<Eigen::Vector3i> cells{{0, 0, 0}, {1, 0, 0}};
  const auto model = make_soft_body_model(lattice_from_cells(cells, 0.1f, {0, 0, 0}), {.cell_size = 0.1f});
  SkinnedMesh skin(model);
  skin.update(SoftBody<3>(model));
  EXPECT_TRUE(skin.positions().empty());
}

}  // namespace
}  // namespace softcell::ppu
