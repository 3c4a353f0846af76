// Contact surfaces of pieces: taken from the whole's, they are what measuring the piece's own mesh gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "fracture_checks.h"
#include "ppu/bodies/break_body.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/surfaces/triangle_distance.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

struct Shape {
  std::string name;
  TriangleMesh mesh;
  float cell_size;
};
void PrintTo(const Shape& shape, std::ostream* to) { *to << shape.name; }

/// Hollow: the inner side is turned around.
TriangleMesh hollow(const TriangleMesh& outside, float share) {
  TriangleMesh mesh = outside;
  const auto first = static_cast<std::uint32_t>(outside.positions.size());
  for (const Vector3f& position : outside.positions) mesh.positions.push_back(share * position);
  for (const Vector3f& normal : outside.normals) mesh.normals.push_back(-normal);
  for (const auto& t : outside.triangles)
    mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  return mesh;
}

class PieceSurfaces : public testing::TestWithParam<Shape> {
 protected:
  /// Pieces of pieces, with cracks that end in them.
  std::vector<SoftBody<3>> broken(std::mt19937& random) const {
    SoftBodySettings settings{.cell_size = GetParam().cell_size, .half_width = 1};
    settings.fracture = Fracture{};
    std::uniform_real_distribution<float> number(-1, 1);
    const auto vector = [&] { return Vector3f(number(random), number(random), number(random)); };
    std::vector<SoftBody<3>> bodies{SoftBody<3>(make_soft_body_model(GetParam().mesh, settings))};
    for (int cuts = 0; cuts < 4; ++cuts) {
      const Cut where = cuts % 2 == 0 ? Cut::plane(0.2f * vector(), vector())
                                      : Cut::stroke(0.5f * vector(), vector(), vector());
      const std::size_t count = bodies.size();
      for (std::size_t b = 0; b < count; ++b)
        for (SoftBody<3>& piece : cut(bodies[b], where)) bodies.push_back(std::move(piece));
    }
    return bodies;
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, PieceSurfaces,
                         testing::Values(Shape{"sphere", make_sphere(0.5f, 3), 0.08f},
                                         Shape{"coarse_sphere", make_sphere(0.5f, 1), 0.21f},
                                         Shape{"torus", make_torus(0.5f, 0.2f, 24, 12), 0.1f},
                                         Shape{"box_on_cells", make_box({1, 0.5f, 0.75f}, 0.25f), 0.125f},
                                         Shape{"box_between_cells", make_box({0.9f, 0.55f, 0.7f}, 10), 0.12f},
                                         Shape{"shell", hollow(make_sphere(0.5f, 3), 0.3f), 0.08f},
                                         Shape{"cone", make_cone(0.4f, 1, 16), 0.12f}),
                         [](const auto& shape) { return shape.param.name; });

TEST_P(PieceSurfaces, AreAsFarAwayAsThePiecesOwnMesh) {
  std::mt19937 random(3);
  std::size_t nodes = 0, too_small = 0;
  for (int seed = 0; seed < 3; ++seed) {
    const std::vector<SoftBody<3>> bodies = broken(random);
    EXPECT_GT(bodies.size(), 2u);
    const ContactModel whole(bodies[0].model().whole());
    for (const SoftBody<3>& body : bodies) {
      const ContactModel piece(body.shared_model(), whole);
      const Lattice<3>& lattice = body.model().lattice();
      const float spacing = lattice.spacing;
      const TriangleGrid triangles(body.model().mesh(), spacing);
      for (std::uint32_t c = 0; c < lattice.cells.size(); ++c)
        for (int n = 0; n < 27; ++n, ++nodes) {
          const Vector3f xi = 0.5f * Vector3i(n % 3, n / 3 % 3, n / 9).cast<float>();
          const Vector3f at = lattice.origin + spacing * (lattice.cells[c].cast<float>() + xi);
          const float measured = std::abs(triangles.signed_distance(at, 2 * spacing)) / spacing;
          const float own = piece.surface.nodes(c)[static_cast<std::size_t>(n)];
          if (measured >= 2 - 1e-3f) {
            EXPECT_LT(own, -2 + 1e-3f);
          } else if (own <= 0) {
            EXPECT_NEAR(-own, measured, 2e-3f) << "node " << n << " of cell " << c;
          } else if (own < measured - 2e-3f) {
            ++too_small;
          } else {
            EXPECT_NEAR(own, measured, 2e-3f) << "node " << n << " of cell " << c;
          }
        }
      for (const TouchingParticle& particle : piece.surface.particles()) EXPECT_GE(particle.allowance, 0);
    }
  }
  // Where air lies between a node and what is gone.
  EXPECT_LT(too_small, nodes / 1000);
}

/// A piece has no solid that the whole has not, and what is gone leaves a node in the air only farther from a surface.
TEST_P(PieceSurfaces, AreNowhereDeeperThanTheWhole) {
  std::mt19937 random(5);
  for (const SoftBody<3>& body : broken(random)) {
    const ContactModel whole(body.model().whole());
    const ContactModel piece(body.shared_model(), whole);
    const std::vector<std::uint32_t>& of = body.model().cracks().cell_of_whole;
    for (std::uint32_t c = 0; c < of.size(); ++c)
      for (std::size_t n = 0; n < ContactSurface::kNodes; ++n) {
        const float own = piece.surface.nodes(c)[n], before = whole.surface.nodes(of[c])[n];
        EXPECT_GE(own, before - 1e-3f);
        EXPECT_TRUE(before > 0 || own <= 0) << own << " from " << before;
      }
  }
}

TEST_P(PieceSurfaces, HavePointsOnTheWholeOfThePiecesMesh) {
  std::mt19937 random(7);
  for (const SoftBody<3>& body : broken(random)) {
    const ContactModel whole(body.model().whole());
    const ContactModel piece(body.shared_model(), whole);
    const Lattice<3>& lattice = body.model().lattice();
    const TriangleMesh& mesh = body.model().mesh();
    const TriangleGrid triangles(mesh, lattice.spacing);
    std::uint32_t last = 0;
    for (const SurfacePointAtRest& point : piece.surface.points()) {
      EXPECT_GE(point.cell, last);
      last = point.cell;
      EXPECT_LT(std::abs(triangles.signed_distance(point.rest, lattice.spacing)), 1e-3f * lattice.spacing);
      EXPECT_TRUE((point.xi.array() >= 0).all() && (point.xi.array() <= 1).all());
      const Vector3f drawn =
          lattice.origin + lattice.spacing * (lattice.cells[point.cell].cast<float>() + point.xi);
      EXPECT_LT((drawn - point.rest).norm(), 1e-3f * lattice.spacing);
    }
    for (const auto& triangle : mesh.triangles) {
      const Vector3f middle =
          (mesh.positions[triangle[0]] + mesh.positions[triangle[1]] + mesh.positions[triangle[2]]) / 3;
      float nearest = 1e9f;
      for (const SurfacePointAtRest& point : piece.surface.points())
        nearest = std::min(nearest, (point.rest - middle).norm());
      EXPECT_LT(nearest, 0.6f * lattice.spacing);
    }
  }
}

/// Deep in a thick body distances are counted in steps, on from a crack as well.
TEST(PieceSurface, GrowsDeeperAwayFromACut) {
  SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1};
  settings.fracture = Fracture{};
  SoftBody<3> box(make_soft_body_model(make_box({1.6f, 1.6f, 1.6f}, 0.4f), settings));
  const ContactModel whole(box.shared_model());
  const auto others = cut(box, Cut::plane({0.01f, 0, 0}, {1, 0, 0}));
  ASSERT_EQ(others.size(), 1u);
  for (const SoftBody<3>* body : {static_cast<const SoftBody<3>*>(&box), &others[0]}) {
    const ContactModel piece(body->shared_model(), whole);
    const Lattice<3>& lattice = body->model().lattice();
    const std::vector<std::uint32_t>& of = body->model().cracks().cell_of_whole;
    float deepest = 0, deepest_of_whole = 0;
    for (std::uint32_t c = 0; c < lattice.cells.size(); ++c)
      for (std::size_t n = 0; n < ContactSurface::kNodes; ++n) {
        const float own = piece.surface.nodes(c)[n];
        deepest = std::min(deepest, own);
        deepest_of_whole = std::min(deepest_of_whole, whole.surface.nodes(of[c])[n]);
        // From the cut, which lies at x = 0, and in steps at least as far as on the straight way less a cell.
        const float x = lattice.origin.x() + lattice.spacing * (static_cast<float>(lattice.cells[c].x()) +
                                                                0.5f * static_cast<float>(n % 3));
        EXPECT_GE(own, -std::abs(x) / lattice.spacing - 1.01f);
      }
    EXPECT_LT(deepest_of_whole, -6.5f);
    EXPECT_NEAR(deepest, -4, 1.01f);
  }
}

}  // namespace
}  // namespace softcell::ppu
