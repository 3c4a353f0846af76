// Bodies that fall into pieces: what hangs together, what is drawn, and what is kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "fracture_checks.h"
#include "ppu/bodies/break_body.h"
#include "ppu/fracture/cut_triangle.h"
#include "ppu/fracture/fill_loops.h"
#include "ppu/lattice/embedding.h"
#include "ppu/matching/matching_plan.h"
#include "softcell/soft_bodies/state_hash.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;

struct Case {
  std::string name;
  TriangleMesh mesh;
  float cell_size;
};
void PrintTo(const Case& c, std::ostream* to) { *to << c.name; }

TriangleMesh moved(TriangleMesh mesh, const Vector3f& by) {
  for (Vector3f& position : mesh.positions) position += by;
  return mesh;
}
/// Two solids in one mesh, one in the other's way.
TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
  for (auto triangle : b.triangles) {
    for (std::uint32_t& vertex : triangle) vertex += first;
    a.triangles.push_back(triangle);
  }
  return a;
}
/// Hollow: the inner side is turned around.
TriangleMesh shell(const TriangleMesh& outside, float share) {
  TriangleMesh inside = outside;
  for (Vector3f& position : inside.positions) position *= share;
  for (Vector3f& normal : inside.normals) normal = -normal;
  for (auto& triangle : inside.triangles) std::swap(triangle[1], triangle[2]);
  return both(outside, inside);
}

std::vector<Case> cases() {
  return {
      {"sphere", make_sphere(0.5f, 3), 0.13f},
      {"coarse_sphere", make_sphere(0.5f, 1), 0.21f},
      {"torus", make_torus(0.5f, 0.2f, 24, 12), 0.1f},
      // On the faces of cells, every one of them.
      {"box_on_cells", make_box({1, 0.5f, 0.75f}, 0.25f), 0.25f},
      {"coarse_box_on_cells", make_box({1, 0.5f, 0.75f}, 10), 0.25f},
      {"box_between_cells", make_box({0.9f, 0.55f, 0.7f}, 10), 0.25f},
      {"penguin", make_penguin(1), 0.09f},
      {"car", make_car(1), 0.1f},
      {"cone", make_cone(0.4f, 1, 16), 0.12f},
      {"shell", shell(make_sphere(0.5f, 3), 0.85f), 0.1f},
      {"thin_shell", shell(make_sphere(0.5f, 3), 0.97f), 0.2f},
      {"two_that_overlap", both(make_sphere(0.5f, 2), moved(make_box({0.6f, 0.3f, 0.3f}, 10), {0.4f, 0, 0})),
       0.15f},
  };
}

SoftBodySettings settings_of(const Case& c) { return {.cell_size = c.cell_size, .half_width = 1}; }

std::vector<std::uint32_t> all_faces(const SoftBodyModel<3>& model) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < model.cracks().faces.size(); ++f) faces.push_back(f);
  return faces;
}

/// @return the volume of its mesh
double expect_valid(const SoftBody<3>& body) {
  const SoftBodyModel<3>& model = body.model();
  EXPECT_EQ(unmet_sides(model.mesh()), 0u);
  EXPECT_FALSE(model.mesh().triangles.empty());
  validate(model.mesh());
  EXPECT_GT(model.mass(), 0);
  for (const float mass : model.masses()) EXPECT_GT(mass, 0);
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    EXPECT_TRUE(body.position(i).allFinite());
    EXPECT_TRUE(body.velocities()[i].allFinite());
  }
  // Each vertex is drawn where it was.
  const Embedding& embedding = model.embedding();
  const Lattice<3>& lattice = model.lattice();
  for (const SkinPart& part : embedding.parts)
    for (std::uint32_t g = part.first_group; g < part.first_group + part.group_count; ++g)
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const Vector3f low = lattice.rest_position(part.particle(embedding.groups[g].corner[0]));
        const Vector3f xi(embedding.groups[g].xi[lane], embedding.groups[g].eta[lane],
                          embedding.groups[g].zeta[lane]);
        const Vector3f drawn = low + lattice.spacing * xi;
        const Vector3f& wanted = model.mesh().positions[embedding.vertex_of_slot[4 * g + lane]];
        EXPECT_LT((drawn - wanted).norm(), 1e-4f * lattice.spacing + 1e-5f);
      }
  return volume(model.mesh());
}

class Pieces : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Shapes, Pieces, testing::ValuesIn(cases()),
                         [](const auto& shape) { return shape.param.name; });

TEST_P(Pieces, BrokenAtAllFacesAreClosedAndFillTheWhole) {
  SoftBody<3> body(make_soft_body_model(GetParam().mesh, settings_of(GetParam())));
  const double whole = volume(GetParam().mesh);
  const std::size_t cells = body.model().lattice().cells.size();
  Momenta before, after;
  std::mt19937 random(7);
  stir(body, random, 1);
  before.add(body);
  double sum = 0;
  std::size_t of_pieces = 0;
  for (const BodyPiece<3>& piece : pieces_of(body, all_faces(body.model()))) {
    sum += expect_valid(piece.body);
    of_pieces += piece.body.model().lattice().cells.size();
    after.add(piece.body);
  }
  EXPECT_EQ(of_pieces, cells);
  EXPECT_NEAR(sum, whole, 2e-4 * whole);
  EXPECT_NEAR(after.mass, before.mass, 1e-6 * before.mass);
  EXPECT_LT((after.moment - before.moment).norm(), 1e-6 * before.mass);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-5 * before.mass);
  EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), 1e-5 * before.mass);
}

TEST_P(Pieces, OfRandomBreaksOneAfterTheOtherAreValid) {
  std::mt19937 random(11);
  const auto model = make_soft_body_model(GetParam().mesh, settings_of(GetParam()));
  const double whole = volume(GetParam().mesh);
  for (int seed = 0; seed < 8; ++seed) {
    std::vector<SoftBody<3>> bodies{SoftBody<3>(model)};
    stir(bodies[0], random, 1);
    Momenta before;
    before.add(bodies[0]);
    for (int round = 0; round < 4; ++round) {
      const std::size_t count = bodies.size();
      for (std::size_t b = 0; b < count; ++b) {
        std::vector<std::uint32_t> faces;
        for (std::uint32_t f = 0; f < bodies[b].model().cracks().faces.size(); ++f)
          if (random() % 6 == 0) faces.push_back(f);
        std::vector<BodyPiece<3>> pieces = pieces_of(bodies[b], faces);
        bodies[b] = pieces[0].body;
        for (std::size_t i = 1; i < pieces.size(); ++i) bodies.push_back(std::move(pieces[i].body));
      }
    }
    double sum = 0;
    Momenta after;
    for (SoftBody<3>& body : bodies) {
      sum += expect_valid(body);
      after.add(body);
      for (int step = 0; step < 3; ++step) body.pull(1.0f / 120);
      for (const Vector3f& v : body.velocities()) EXPECT_TRUE(v.allFinite());
    }
    EXPECT_NEAR(sum, whole, 2e-4 * whole);
    EXPECT_NEAR(after.mass, before.mass, 1e-6 * before.mass);
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-5 * before.mass);
    EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), 1e-5 * before.mass);
  }
}

TEST_P(Pieces, OfRandomPlanesAndStrokesAreValid) {
  std::mt19937 random(13);
  std::uniform_real_distribution<float> number(-1, 1);
  const auto vector = [&] { return Vector3f(number(random), number(random), number(random)); };
  const auto model = make_soft_body_model(GetParam().mesh, settings_of(GetParam()));
  const double whole = volume(GetParam().mesh);
  for (int seed = 0; seed < 6; ++seed) {
    std::vector<SoftBody<3>> bodies{SoftBody<3>(model)};
    for (int cuts = 0; cuts < 8; ++cuts) {
      const Cut where = cuts % 2 == 0 ? Cut::plane(0.3f * vector(), vector())
                                      : Cut::stroke(vector(), vector(), 2 * vector());
      const std::size_t count = bodies.size();
      for (std::size_t b = 0; b < count; ++b)
        for (SoftBody<3>& piece : cut(bodies[b], where)) bodies.push_back(std::move(piece));
    }
    double sum = 0;
    for (const SoftBody<3>& body : bodies) sum += expect_valid(body);
    EXPECT_NEAR(sum, whole, 2e-4 * whole);
  }
}

std::shared_ptr<const SoftBodyModel<3>> bar(int cells, int half_width = 2) {
  return make_soft_body_model(make_box({0.1f * static_cast<float>(cells), 0.1f, 0.1f}, 0.05f),
                              {.cell_size = 0.1f, .half_width = half_width});
}

TEST(Cut, AcrossABarMakesTwoBars) {
  SoftBody<3> body(bar(6), {1, 2, 3});
  const auto others = cut(body, Cut::plane({0.9f + 0.001f, 2, 3}, {1, 0, 0}));
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(body.model().lattice().cells.size(), 4u);
  EXPECT_EQ(others[0].model().lattice().cells.size(), 2u);
  EXPECT_EQ(body.positions().size(), 5u * 4);
  EXPECT_EQ(others[0].positions().size(), 3u * 4);
  EXPECT_NEAR(volume(body.model().mesh()), 0.004, 1e-7);
  EXPECT_NEAR(volume(others[0].model().mesh()), 0.002, 1e-7);
  EXPECT_TRUE(body.model().is_piece());
}

TEST(Cut, ThatMissesChangesNothing) {
  SoftBody<3> body(bar(6));
  const auto before = body.shared_model();
  EXPECT_TRUE(cut(body, Cut::plane({5, 0, 0}, {1, 0, 0})).empty());
  EXPECT_TRUE(cut(body, Cut::stroke({0, 5, -1}, {0, 0, 2}, {0, 1, 0})).empty());
  EXPECT_EQ(body.shared_model(), before);
}

TEST(Cut, OfNoAreaIsRefused) {
  SoftBody<3> body(bar(3));
  EXPECT_THROW(cut(body, Cut::stroke({0, 0, 0}, {1, 0, 0}, {2, 0, 0})), std::invalid_argument);
  EXPECT_THROW(cut(body, Cut::plane({0, 0, 0}, {std::nanf(""), 0, 0})), std::invalid_argument);
}

TEST(Cut, HalfThroughLeavesOneBodyWhoseRegionsEndAtTheCrack) {
  const auto model =
      make_soft_body_model(make_box({0.6f, 0.4f, 0.1f}, 0.05f), {.cell_size = 0.1f, .half_width = 1});
  SoftBody<3> body(model);
  // From the top to the middle.
  EXPECT_TRUE(cut(body, Cut::stroke({0.001f, 0.001f, -1}, {0, 0, 2}, {0, 1, 0})).empty());
  EXPECT_EQ(unmet_sides(body.model().mesh()), 0u);
  EXPECT_NEAR(volume(body.model().mesh()), 0.024, 1e-6);
  // Along the crack are two cells, whose upper four corners are double; the two below them are its tip.
  const Lattice<3>& lattice = body.model().lattice();
  EXPECT_EQ(body.positions().size(), model->particles() + 4);
  std::size_t across = 0, at_tip = 0;
  const auto sums = body.model().plan();
  for (std::size_t r = 0; r < sums->regions(); ++r) {
    const auto members = sums->sums().members(r);
    for (const std::uint32_t a : members)
      for (const std::uint32_t b : members)
        if (a < b && lattice.particles[a] == lattice.particles[b])
          ++(lattice.particles[a].y() == 3 ? at_tip : across);
  }
  EXPECT_EQ(across, 0u)
      << "regions that hold both sides of the crack at its upper end, two links from its tip";
  EXPECT_GT(at_tip, 0u) << "the tip's own regions hold both sides next to it";
}

TEST(PiecesOfABody, WithoutAMesh) {
  std::vector<Vector3i> cells;
  for (int x = 0; x < 4; ++x) cells.emplace_back(x, 0, 0);
  SoftBody<3> body(
      make_soft_body_model(lattice_from_cells(cells, 0.1f), SoftBodySettings{.cell_size = 0.1f}));
  const auto others = cut(body, Cut::plane({0.2f, 0, 0}, {1, 0, 0}));
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].positions().size(), 12u);
  EXPECT_TRUE(others[0].model().mesh().triangles.empty());
}

TEST(PiecesOfABody, HaveTheMaterialThatTheBodyHasNow) {
  SoftBody<3> body(bar(4));
  SoftBodySettings softer = body.settings();
  softer.alpha = 0.125f;
  softer.friction = 0.25f;
  body.set_material(softer);
  const auto others = cut(body, Cut::plane({0, 0, 0}, {1, 0, 0}));
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].settings(), softer);
  EXPECT_EQ(body.settings(), softer);
}

TEST(PiecesOfABody, KeepWhatAPlasticBodyKeptOfDeformations) {
  SoftBodySettings tin{.cell_size = 0.1f, .half_width = 1};
  tin.plasticity = Plasticity{};
  SoftBody<3> body(make_soft_body_model(make_box({0.6f, 0.1f, 0.1f}, 0.1f), tin));
  std::vector<Vector3f> bent;
  for (const Vector3f& x : body.positions()) bent.push_back(x + Vector3f(0, x.x() * x.x(), 0));
  body.set_rest_positions(bent);
  const std::vector<Vector3f> before = body.rest_positions();
  std::vector<BodyPiece<3>> pieces = pieces_of(body, faces_across(body, Cut::plane({0, 0, 0}, {1, 0, 0})));
  ASSERT_EQ(pieces.size(), 2u);
  for (const BodyPiece<3>& piece : pieces) {
    ASSERT_TRUE(piece.body.has_own_rest());
    const std::vector<Vector3f> rest = piece.body.rest_positions();
    for (std::size_t i = 1; i < rest.size(); ++i)
      EXPECT_LT((rest[i] - rest[0] - (before[piece.particle_of[i]] - before[piece.particle_of[0]])).norm(),
                1e-5f);
  }
}

/// A bar of single cells in a row: cuts leave it in pieces of 1, 3, 2 and 6 cells.
SoftBody<3> bar_to_cut(std::uint32_t least_cells) {
  SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1};
  settings.fracture = Fracture{.least_cells = least_cells};
  return SoftBody<3>(make_soft_body_model(make_box({1.2f, 0.1f, 0.1f}, 0.05f), settings));
}
std::vector<std::uint32_t> faces_of_cuts(const SoftBody<3>& body) {
  std::vector<std::uint32_t> faces;
  for (const float at : {-0.499f, -0.199f, 0.001f})
    for (const std::uint32_t face : faces_across(body, Cut::plane({at, 0, 0}, {1, 0, 0})))
      faces.push_back(face);
  return faces;
}

TEST(PiecesOfABody, VanishIfTheyHaveFewerCellsThanStated) {
  for (const std::uint32_t least_cells : {1u, 2u, 3u, 4u, 1000u}) {
    SCOPED_TRACE(least_cells);
    SoftBody<3> body = bar_to_cut(least_cells);
    std::mt19937 random(3);
    stir(body, random, 0.1f);
    const auto planned = plan_pieces(body.shared_model(), faces_of_cuts(body), least_cells_of(body));
    std::vector<std::size_t> stay, vanished;
    for (const BodyPiece<3>& piece : planned.stay) stay.push_back(piece.body.model().lattice().cells.size());
    for (const auto& particles : planned.vanished) vanished.push_back(particles.size() / 4 - 1);
    std::vector<std::size_t> expected_stay{6}, expected_vanished;
    for (const std::size_t cells : {1u, 3u, 2u})
      (cells < least_cells ? expected_vanished : expected_stay).push_back(cells);
    EXPECT_EQ(stay, expected_stay);
    EXPECT_EQ(vanished, expected_vanished);
    for (const auto& particles : planned.vanished) EXPECT_TRUE(std::ranges::is_sorted(particles));
    // What stays is what it is when everything does, and has its share of the mass: one of 12 for each cell.
    SoftBody<3> all = bar_to_cut(1);
    stir(all, random = std::mt19937(3), 0.1f);
    const auto of_all = pieces_of(all, faces_of_cuts(all)), own = pieces_of(body, faces_of_cuts(body));
    ASSERT_EQ(own.size(), stay.size());
    for (const BodyPiece<3>& piece : own) {
      expect_valid(piece.body);
      const std::size_t cells = piece.body.model().lattice().cells.size();
      EXPECT_NEAR(piece.body.model().mass(), body.model().mass() * static_cast<float>(cells) / 12, 1e-5f);
      const auto same = std::ranges::find_if(
          of_all, [&](const BodyPiece<3>& other) { return other.particle_of == piece.particle_of; });
      ASSERT_NE(same, of_all.end());
      EXPECT_EQ(state_hash(piece.body), state_hash(same->body));
    }
  }
}

TEST(PiecesOfABody, VanishWhenItIsCutAndWhenItBreaks) {
  SoftBody<3> body = bar_to_cut(3);
  EXPECT_TRUE(cut(body, Cut::plane({0.401f, 0, 0}, {1, 0, 0})).empty());
  EXPECT_EQ(body.model().lattice().cells.size(), 10u);
  EXPECT_EQ(unmet_sides(body.model().mesh()), 0u);
  EXPECT_NEAR(volume(body.model().mesh()), 0.01, 1e-6);
  ASSERT_EQ(cut(body, Cut::plane({0.101f, 0, 0}, {1, 0, 0})).size(), 1u);
  EXPECT_EQ(body.model().lattice().cells.size(), 7u);
  // All faces break: the largest piece stays, a single cell.
  SoftBodySettings brittle = body.settings();
  brittle.fracture->stretch = 0.1f;
  body.set_material(brittle);
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    const Vector3f x = body.position(i);
    body.set_particle(i, {1.2f * x.x(), x.y(), x.z()}, {0, 0, 0});
  }
  EXPECT_TRUE(break_where_strained(body).empty());
  EXPECT_EQ(body.model().lattice().cells.size(), 1u);
  EXPECT_EQ(body.settings(), brittle);
}

TEST(PiecesOfABody, OfABodyWithoutAFractureAllStay) {
  SoftBody<3> body(bar(6));
  ASSERT_EQ(cut(body, Cut::plane({0.201f, 0, 0}, {1, 0, 0})).size(), 1u);
  EXPECT_EQ(least_cells_of(body), 1u);
}

TEST(PiecesOfABody, DrawCutsInTheMaterialOfThatName) {
  TriangleMesh mesh = make_box({0.4f, 0.1f, 0.1f}, 0.1f);
  MeshMaterial crust, crumb;
  crust.name = "crust";
  crumb.name = "cut";
  crumb.base_colour = Eigen::Vector4f(1, 1, 0.5f, 1);
  mesh.materials = {crust, crumb};
  mesh.parts = {{.object = "loaf",
                 .material = 0,
                 .first_triangle = 0,
                 .triangle_count = static_cast<std::uint32_t>(mesh.triangles.size())}};
  SoftBody<3> body(make_soft_body_model(mesh, {.cell_size = 0.1f}));
  cut(body, Cut::plane({0.001f, 0, 0}, {1, 0, 0}));
  const TriangleMesh& piece = body.model().mesh();
  ASSERT_EQ(piece.parts.size(), 2u);
  EXPECT_EQ(piece.parts[0].material, 0u);
  EXPECT_EQ(piece.parts[1].material, 1u);
  EXPECT_EQ(piece.materials, mesh.materials);
  for (std::uint32_t t = 0; t < piece.parts[1].triangle_count; ++t)
    for (const std::uint32_t v : piece.triangles[piece.parts[1].first_triangle + t])
      EXPECT_NEAR(std::abs(piece.normals[v].x()), 1, 1e-6f);
}

TEST(CutTriangle, CoversTheTriangleOnceAndStaysInItsCells) {
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    // Every third one coarse, so that many coordinates are equal.
    const std::int64_t grain = i % 3 == 0 ? kUnitsPerCell / 2 : 1;
    std::array<UnitPoint, 3> corners;
    for (UnitPoint& corner : corners)
      for (std::int64_t& at : corner)
        at = static_cast<std::int64_t>(random() % (3 * kUnitsPerCell - 2)) / grain * grain / 2 * 2 + 1;
    const UnitPoint normal = normal_of(corners);
    Vector3d whole, sum = Vector3d::Zero();
    for (std::size_t d = 0; d < 3; ++d) whole[static_cast<int>(d)] = static_cast<double>(normal[d]);
    const auto place = [&](const CutVertex& v) -> Vector3d {
      const auto corner = [&](std::size_t k) {
        return Vector3d(static_cast<double>(corners[k % 3][0]), static_cast<double>(corners[k % 3][1]),
                        static_cast<double>(corners[k % 3][2]));
      };
      if (v.planes == 0) return corner(v.of);
      const auto at = [&](std::size_t n) { return static_cast<double>(v.plane[n] * kUnitsPerCell); };
      if (v.planes == 1) {
        const Vector3d a = corner(v.of), b = corner(v.of + 1u);
        return a + (at(0) - a[v.axis[0]]) / (b[v.axis[0]] - a[v.axis[0]]) * (b - a);
      }
      Vector3d point;
      const int free = 3 - v.axis[0] - v.axis[1];
      point[v.axis[0]] = at(0), point[v.axis[1]] = at(1);
      const Vector3d a = corner(0);
      point[free] = a[free] - (whole[v.axis[0]] * (point[v.axis[0]] - a[v.axis[0]]) +
                               whole[v.axis[1]] * (point[v.axis[1]] - a[v.axis[1]])) /
                                  whole[free];
      return point;
    };
    for (const CutPolygon& polygon : cut_triangle(corners)) {
      ASSERT_GE(polygon.vertices.size(), 3u);
      Vector3d area = Vector3d::Zero();
      const Vector3d first = place(polygon.vertices[0]);
      for (std::size_t k = 1; k + 1 < polygon.vertices.size(); ++k)
        area += (place(polygon.vertices[k]) - first).cross(place(polygon.vertices[k + 1]) - first);
      sum += area;
      for (const CutVertex& vertex : polygon.vertices)
        for (int d = 0; d < 3; ++d) {
          EXPECT_GE(place(vertex)[d],
                    static_cast<double>(polygon.cell[static_cast<std::size_t>(d)] * kUnitsPerCell) - 1e-3);
          EXPECT_LE(
              place(vertex)[d],
              static_cast<double>((polygon.cell[static_cast<std::size_t>(d)] + 1) * kUnitsPerCell) + 1e-3);
        }
    }
    EXPECT_LT((sum - whole).norm(), 1e-6 * whole.norm() + 1e6) << "triangle " << i;
  }
}

double area_of(const std::vector<Eigen::Vector2d>& points,
               const std::vector<std::array<std::uint32_t, 3>>& triangles, bool absolute) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector2d u = points[b] - points[a], v = points[c] - points[a];
    const double area = (u.x() * v.y() - u.y() * v.x()) / 2;
    sum += absolute ? std::abs(area) : area;
  }
  return sum;
}

TEST(FillLoops, FillsAStarWithTwoHolesWithoutOverlaps) {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::uint32_t> star, hole, other;
  for (int i = 0; i < 14; ++i) {
    const double angle = std::numbers::pi * i / 7, radius = i % 2 == 0 ? 1 : 0.55;
    star.push_back(static_cast<std::uint32_t>(points.size()));
    points.push_back(radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  for (int i = 0; i < 5; ++i) {
    const double angle = -2 * std::numbers::pi * i / 5;
    hole.push_back(static_cast<std::uint32_t>(points.size()));
    points.push_back(0.2 * Eigen::Vector2d(std::cos(angle), std::sin(angle)) + Eigen::Vector2d(0.25, 0));
    other.push_back(static_cast<std::uint32_t>(points.size()));
    points.push_back(0.2 * Eigen::Vector2d(std::cos(angle), std::sin(angle)) - Eigen::Vector2d(0.25, 0));
  }
  const auto triangles = fill_loops(points, {star, hole, other});
  EXPECT_EQ(triangles.size(), 14u + 5 + 5 + 2);
  EXPECT_NEAR(area_of(points, triangles, false), area_of(points, triangles, true), 1e-12);
  const double of_star = 14 * 0.5 * 1 * 0.55 * std::sin(std::numbers::pi / 7);
  const double of_hole = 5 * 0.5 * 0.04 * std::sin(2 * std::numbers::pi / 5);
  EXPECT_NEAR(area_of(points, triangles, false), of_star - 2 * of_hole, 1e-12);
}

TEST(FillLoops, KeepsPointsOnStraightSides) {
  const std::vector<Eigen::Vector2d> points{{0, 0}, {0.5, 0}, {1, 0}, {1, 0.5}, {1, 1}, {0, 1}, {0, 0.3}};
  const auto triangles = fill_loops(points, {{0, 1, 2, 3, 4, 5, 6}});
  EXPECT_EQ(triangles.size(), 5u);
  EXPECT_NEAR(area_of(points, triangles, true), 1, 1e-12);
}

}  // namespace
}  // namespace softcell::ppu
