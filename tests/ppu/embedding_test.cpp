#include "ppu/lattice/embedding.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/numbers/half.h"
#include "ppu/reference/skin_scalar.h"
#include "softcell/mesh_import/mesh_import.h"
#include "softcell/soft_bodies/shapes.h"
#include "support/float_from_half.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

struct Body {
  TriangleMesh mesh;
  Lattice<3> lattice;
  Embedding embedding;
  std::vector<Vector3f> rest;  ///< of the particles

  Body(TriangleMesh shape, Lattice<3> cells)
      : mesh(std::move(shape)), lattice(std::move(cells)), embedding(embed(mesh, lattice)) {
    for (std::size_t p = 0; p < lattice.particles.size(); ++p) rest.push_back(lattice.rest_position(p));
  }

  /// Calls visit(part, group, lane, mesh vertex, slot) for all slots.
  template <class Visit>
  void for_each_slot(Visit visit) const {
    for (const SkinPart& part : embedding.parts) {
      for (std::uint32_t group = part.first_group; group < part.first_group + part.group_count; ++group) {
        for (int lane = 0; lane < 4; ++lane) {
          const std::uint32_t slot = 4 * group + static_cast<std::uint32_t>(lane);
          visit(part, group, lane, embedding.vertex_of_slot[slot], slot);
        }
      }
    }
  }

  template <class Map>
  std::vector<Vector3f> moved(Map map) const {
    std::vector<Vector3f> positions;
    for (const Vector3f& x : rest) positions.push_back(map(x.cast<double>()).template cast<float>());
    return positions;
  }
};

Body car() {
  TriangleMesh mesh = make_car(2);
  Lattice<3> lattice = voxelize(mesh, 0.1f);
  return {std::move(mesh), std::move(lattice)};
}

/// The surface cells of a block of n^3 cells, and a box whose faces run through the middles of them.
Body large_shell(int n) {
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) {
        const bool surface = x == 0 || y == 0 || z == 0 || x == n - 1 || y == n - 1 || z == n - 1;
        if (surface) cells.emplace_back(x, y, z);
      }
    }
  }
  const float size = static_cast<float>(n);
  TriangleMesh mesh = make_box({size - 0.5f, size - 0.5f, size - 0.5f}, 0.5f);
  return {std::move(mesh), lattice_from_cells(cells, 1.0f, Vector3f::Constant(-0.5f * size))};
}

/// A smooth, strong deformation: bent, stretched and sheared.
Vector3d deformed(const Vector3d& x) {
  return Vector3d(1.2 * x.x() + 0.3 * x.y() * x.z(), x.y() + 0.2 * x.x() * x.x(),
                  x.z() - 0.4 * x.y() * x.x() + 0.1 * x.y());
}

TEST(Embedding, ReproducesTheMeshAtRest) {
  const Body body = car();
  body.for_each_slot(
      [&](const SkinPart& part, std::uint32_t group, int lane, std::uint32_t vertex, std::uint32_t) {
        const ReferenceVertex at = evaluate_reference(body.embedding, part, group, lane, body.rest);
        ASSERT_LT((at.position - body.mesh.positions[vertex].cast<double>()).norm(), 1e-6) << vertex;
        ASSERT_LT((at.normal - body.mesh.normals[vertex].cast<double>()).norm(), 1e-5) << vertex;
      });
}

TEST(Embedding, MovesWithAllParticlesAlike) {  // partition of unity
  const Body body = car();
  const std::vector<Vector3f> one_point(body.rest.size(), Vector3f(3, -7, 11));
  body.for_each_slot(
      [&](const SkinPart& part, std::uint32_t group, int lane, std::uint32_t vertex, std::uint32_t) {
        const ReferenceVertex at = evaluate_reference(body.embedding, part, group, lane, one_point);
        ASSERT_LT((at.position - Vector3d(3, -7, 11)).norm(), 1e-12);
        ASSERT_EQ(at.normal, body.mesh.normals[vertex].cast<double>()) << "a flat cell keeps the rest normal";
      });
}

TEST(Embedding, IsExactForAffineMaps) {
  const Body body = car();
  Matrix3d a;
  a << 1.1, 0.3, -0.2, 0.1, 0.8, 0.4, -0.3, 0.2, 1.3;
  const Matrix3d cofactor = a.determinant() * a.inverse().transpose();
  const std::vector<Vector3f> moved =
      body.moved([&](const Vector3d& x) { return Vector3d(a * x + Vector3d(1, 2, 3)); });
  body.for_each_slot(
      [&](const SkinPart& part, std::uint32_t group, int lane, std::uint32_t vertex, std::uint32_t) {
        const ReferenceVertex at = evaluate_reference(body.embedding, part, group, lane, moved);
        const Vector3d expected = a * body.mesh.positions[vertex].cast<double>() + Vector3d(1, 2, 3);
        ASSERT_LT((at.position - expected).norm(), 2e-6) << vertex;
        const Vector3d normal = (cofactor * body.mesh.normals[vertex].cast<double>()).normalized();
        ASSERT_LT((at.normal - normal).norm(), 3e-5) << vertex;
      });
}

// Along a straight line through several cells the position has no jump, and on a face both cells agree.
TEST(Embedding, IsContinuousAcrossFaces) {
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 3; ++z) cells.emplace_back(x, y, z);
    }
  }
  TriangleMesh line;
  for (int i = 0; i <= 3000; ++i) {
    line.positions.push_back(Vector3f(1, 0.7f, 0.45f) * (static_cast<float>(i) / 1000.0f));
    line.normals.emplace_back(0, 0, 1);
  }
  const Body body(line, lattice_from_cells(cells, 1.0f, Vector3f::Zero()));
  const std::vector<Vector3f> moved = body.moved(deformed);
  std::vector<Vector3d> at(line.positions.size());
  body.for_each_slot(
      [&](const SkinPart& part, std::uint32_t group, int lane, std::uint32_t vertex, std::uint32_t) {
        at[vertex] = evaluate_reference(body.embedding, part, group, lane, moved).position;
      });
  for (std::size_t i = 1; i < at.size(); ++i)
    ASSERT_LT((at[i] - at[i - 1]).norm(), 0.006) << i;  // |dx/dX| < 6
}

// The normal is cof(F) N with F = dx/dX; here dx/dX comes from central differences between probes beside the
// vertex, so that both F and the orthogonality of the normal to the deformed tangents are checked against
// positions alone.
TEST(Embedding, NormalIsOrthogonalToTheDeformedTangents) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> inside(0.02f, 0.98f), any(-1, 1);
  constexpr float kStep = 0x1p-7f;
  const Vector3f normals[] = {
      {1, 0, 0}, {0, -1, 0}, Vector3f(1, 2, -3).normalized(), Vector3f(-2, 1, 1).normalized()};
  for (const Vector3f& normal : normals) {
    const Vector3f tangent = normal.unitOrthogonal(), bitangent = normal.cross(tangent);
    TriangleMesh probes;
    for (int i = 0; i < 200; ++i) {
      const Vector3f x(inside(random), inside(random), inside(random));
      for (const Vector3f& offset :
           {Vector3f(0, 0, 0), tangent, Vector3f(-tangent), bitangent, Vector3f(-bitangent)}) {
        probes.positions.push_back((x + kStep * offset).cwiseMax(0.0f).cwiseMin(1.0f));
        probes.normals.push_back(normal);
      }
    }
    const Eigen::Vector3i cell(0, 0, 0);
    const Body body(probes, lattice_from_cells({&cell, 1}, 1.0f, Vector3f::Zero()));
    std::vector<Vector3f> moved = body.rest;
    for (Vector3f& x : moved) x += 0.25f * Vector3f(any(random), any(random), any(random));
    std::vector<ReferenceVertex> at(probes.positions.size());
    body.for_each_slot(
        [&](const SkinPart& part, std::uint32_t group, int lane, std::uint32_t vertex, std::uint32_t) {
          at[vertex] = evaluate_reference(body.embedding, part, group, lane, moved);
        });
    for (std::size_t i = 0; i < at.size(); i += 5) {
      const Vector3d t = at[i + 1].position - at[i + 2].position, b = at[i + 3].position - at[i + 4].position;
      const Vector3d& n = at[i].normal;
      ASSERT_NEAR(n.norm(), 1, 1e-12);
      ASSERT_LT(std::abs(n.dot(t)) / t.norm(), 2e-3);
      ASSERT_LT(std::abs(n.dot(b)) / b.norm(), 2e-3);
      ASSERT_GT(n.dot(t.cross(b).normalized()), 0.99);
    }
  }
}

TEST(Embedding, EveryVertexHasItsSlotAndIndicesReproduceTheMesh) {
  const Body body = car();
  const Embedding& e = body.embedding;
  ASSERT_EQ(e.slot_of_vertex.size(), body.mesh.positions.size());
  ASSERT_EQ(e.vertex_of_slot.size(), 4 * e.groups.size());
  for (std::uint32_t v = 0; v < e.slot_of_vertex.size(); ++v)
    ASSERT_EQ(e.vertex_of_slot[e.slot_of_vertex[v]], v);
  ASSERT_EQ(e.indices.size(), 3 * body.mesh.triangles.size());
  for (std::size_t i = 0; i < e.indices.size(); ++i) {
    ASSERT_EQ(e.vertex_of_slot[e.indices[i]], body.mesh.triangles[i / 3][i % 3]);
  }
  // Only last groups of a cell repeat a vertex.
  std::size_t repeats = 0;
  for (std::uint32_t slot = 0; slot < e.vertex_of_slot.size(); ++slot)
    repeats += e.slot_of_vertex[e.vertex_of_slot[slot]] != slot;
  EXPECT_LE(repeats, 3 * body.lattice.cells.size());
}

void expect_valid_parts(const Body& body) {
  const Embedding& e = body.embedding;
  std::uint32_t next_group = 0;
  for (const SkinPart& part : e.parts) {
    ASSERT_EQ(part.first_group, next_group);
    ASSERT_GE(part.group_count, 1u);
    ASSERT_LE(part.group_count, kMaxPartGroups);
    const std::uint32_t corners = part.window[0].count + part.window[1].count;
    ASSERT_LE(corners, spu::kSkinMaxCorners);
    for (const SkinPart::Run& run : part.window) ASSERT_LE(run.first_particle + run.count, body.rest.size());
    ASSERT_EQ(e.groups[part.first_group].continues[0], 0);
    for (std::uint32_t g = part.first_group; g < part.first_group + part.group_count; ++g) {
      const spu::SkinGroup& group = e.groups[g];
      for (const std::uint16_t corner : group.corner) ASSERT_LT(corner, corners);
      const bool same = g != part.first_group &&
                        std::equal(std::begin(group.corner), std::end(group.corner), e.groups[g - 1].corner);
      ASSERT_EQ(group.continues[0], same ? 1 : 0) << g;
      for (int lane = 0; lane < 4; ++lane) {
        for (const float xi : {group.xi[lane], group.eta[lane], group.zeta[lane]})
          ASSERT_TRUE(xi >= 0 && xi <= 1) << xi;
      }
    }
    next_group += part.group_count;
  }
  EXPECT_EQ(next_group, e.groups.size());
}

TEST(Embedding, CutsASmallBodyIntoPartsWithinTheKernelsLimits) {
  const Body body = car();
  expect_valid_parts(body);
  EXPECT_GE(body.embedding.parts.size(), 2u);
}

TEST(Embedding, CutsALargeLatticeIntoPartsWithinTheKernelsLimits) {
  const Body body = large_shell(60);
  ASSERT_GT(body.rest.size(), 3 * spu::kSkinMaxCorners);
  expect_valid_parts(body);
  // Two runs are used where one cannot reach: on the end layers, where two layers are 2 x 61 x 61 particles.
  EXPECT_TRUE(std::any_of(body.embedding.parts.begin(), body.embedding.parts.end(),
                          [](const SkinPart& part) { return part.window[1].count > 0; }));
  body.for_each_slot(
      [&](const SkinPart& part, std::uint32_t group, int lane, std::uint32_t vertex, std::uint32_t) {
        const ReferenceVertex at = evaluate_reference(body.embedding, part, group, lane, body.rest);
        ASSERT_LT((at.position - body.mesh.positions[vertex].cast<double>()).norm(), 1e-5) << vertex;
      });
}

TEST(Embedding, PutsVerticesOnOuterFacesIntoTheCellBehind) {
  const Eigen::Vector3i cell(0, 0, 0);
  const Lattice<3> lattice = lattice_from_cells({&cell, 1}, 0.5f, Vector3f(1, 2, 3));
  TriangleMesh corners;
  for (int k = 0; k < 8; ++k) {
    corners.positions.push_back(Vector3f(1, 2, 3) + 0.5f * Vector3f(static_cast<float>(k & 1),
                                                                    static_cast<float>((k >> 1) & 1),
                                                                    static_cast<float>(k >> 2)));
    corners.normals.emplace_back(0, 1, 0);
  }
  const Body body(corners, lattice);
  ASSERT_EQ(body.embedding.groups.size(), 2u);
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t slot = body.embedding.slot_of_vertex[k];
    const spu::SkinGroup& group = body.embedding.groups[slot / 4];
    EXPECT_EQ(group.xi[slot % 4], static_cast<float>(k & 1));
    EXPECT_EQ(group.eta[slot % 4], static_cast<float>((k >> 1) & 1));
    EXPECT_EQ(group.zeta[slot % 4], static_cast<float>(k >> 2));
  }
}

TEST(Embedding, PutsVerticesOnInnerFacesIntoTheCellAbove) {
  const std::vector<Eigen::Vector3i> cells{{0, 0, 0}, {1, 0, 0}};
  TriangleMesh one;
  one.positions = {Vector3f(1, 0.5f, 0.5f)};
  one.normals = {Vector3f(1, 0, 0)};
  const Embedding embedding = embed(one, lattice_from_cells(cells, 1.0f, Vector3f::Zero()));
  EXPECT_EQ(embedding.groups[0].xi[0], 0.0f);
}

TEST(Embedding, SaysWhatToDoWithAVertexThatNoTriangleHas) {
  const Eigen::Vector3i cell(0, 0, 0);
  const Lattice<3> lattice = lattice_from_cells({&cell, 1}, 1.0f, Vector3f::Zero());
  TriangleMesh mesh;
  mesh.positions = {{0.1f, 0.1f, 0.1f}, {0.9f, 0.1f, 0.1f}, {0.1f, 0.9f, 0.1f}, {7, 0, 0}};
  mesh.normals.assign(4, Vector3f(0, 0, 1));
  mesh.triangles = {{0, 1, 2}};
  const auto refusal = [&] {
    try {
      embed(mesh, lattice);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(refusal().find("vertex 3 at (7, 0, 0)"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find("it belongs to no triangle, so leave it out of the mesh"), std::string::npos)
      << refusal();
  mesh.triangles = {{0, 1, 3}};
  EXPECT_NE(refusal().find("the lattice must cover the mesh"), std::string::npos) << refusal();
}

TEST(Embedding, RefusesAVertexOutsideTheLattice) {
  const Eigen::Vector3i cell(0, 0, 0);
  const Lattice<3> lattice = lattice_from_cells({&cell, 1}, 1.0f, Vector3f::Zero());
  for (const Vector3f& outside : {Vector3f(0.5f, 1.01f, 0.5f), Vector3f(-1e30f, 0, 0), Vector3f(NAN, 0, 0)}) {
    TriangleMesh mesh;
    mesh.positions = {outside};
    mesh.normals = {Vector3f(0, 1, 0)};
    try {
      embed(mesh, lattice);
      ADD_FAILURE() << "embedded " << outside.transpose();
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("vertex 0 at ("), std::string::npos) << error.what();
    }
  }
}

TEST(Embedding, EmbedsAMeshThatNobodyHereModelled) {
  // Debian package glmark2-data, GPL-3+.
  const std::filesystem::path bunny = "/usr/share/glmark2/models/bunny.obj";
  if (!std::filesystem::exists(bunny)) GTEST_SKIP() << "install glmark2-data for " << bunny;
  TriangleMesh mesh = import_mesh(bunny);
  fit(mesh, 1);
  Lattice<3> lattice = voxelize(mesh, 0.08f);
  const Body body(std::move(mesh), std::move(lattice));
  expect_valid_parts(body);
  EXPECT_GE(body.embedding.parts.size(), 12u);  // six SPEs have at least two each
  body.for_each_slot(
      [&](const SkinPart& part, std::uint32_t group, int lane, std::uint32_t vertex, std::uint32_t) {
        const ReferenceVertex at = evaluate_reference(body.embedding, part, group, lane, body.rest);
        ASSERT_LT((at.position - body.mesh.positions[vertex].cast<double>()).norm(), 1e-6) << vertex;
      });
}

/// Distance of two halves of the same sign in units in the last place.
int half_ulps(std::uint16_t a, std::uint16_t b) {
  const auto ordered = [](std::uint16_t h) {
    return (h & 0x8000u) ? -static_cast<int>(h & 0x7FFFu) : static_cast<int>(h);
  };
  return std::abs(ordered(a) - ordered(b));
}

TEST(SkinScalar, AgreesWithTheReferenceToOneHalfUlp) {
  const Body body = car();
  const std::vector<Vector3f> moved = body.moved(deformed);
  const Vector3f origin(-4, -5, -6);  // so that no coordinate is near 0, where an ulp is tiny
  for (const SkinPart& part : body.embedding.parts) {
    std::vector<spu::SkinnedVertex> out(4 * part.group_count);
    skin_scalar(body.embedding, part, moved, origin, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const ReferenceVertex at =
          evaluate_reference(body.embedding, part, part.first_group + static_cast<std::uint32_t>(i / 4),
                             static_cast<int>(i % 4), moved);
      const Vector3f position = (at.position - origin.cast<double>()).cast<float>();
      for (int d = 0; d < 3; ++d)
        ASSERT_LE(half_ulps(out[i].position[d], half_from_float(position[d])), 1) << i;
      const Vector3d normal(float_from_half(out[i].normal[0]), float_from_half(out[i].normal[1]),
                            float_from_half(out[i].normal[2]));
      ASSERT_LT((normal - at.normal).norm(), 1e-3) << i;
      ASSERT_EQ(out[i].position[3], 0x3C00u);
      ASSERT_EQ(out[i].normal[3], 0u);
    }
  }
}

}  // namespace
}  // namespace softcell::ppu
