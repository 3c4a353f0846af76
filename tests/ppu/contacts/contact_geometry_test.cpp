// Distances from shapes, triangles and surfaces at rest, and places in deformed cells, against formulas.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "ppu/mesh/outer_surface.h"
#include "ppu/mesh/solid.h"
#include "ppu/obstacles/corner_set.h"
#include "ppu/obstacles/edge_set.h"
#include "ppu/obstacles/known_triangles.h"
#include "ppu/obstacles/obstacle.h"
#include "ppu/obstacles/side_by_side.h"
#include "ppu/obstacles/triangle_boxes.h"
#include "ppu/obstacles/triangle_sheets.h"
#include "ppu/surfaces/cell_boxes.h"
#include "ppu/surfaces/cell_finder.h"
#include "ppu/surfaces/contact_surface.h"
#include "ppu/surfaces/inner_places.h"
#include "ppu/surfaces/point_chooser.h"
#include "ppu/surfaces/triangle_distance.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

class RandomPoints {
 public:
  Vector3f in_cube(float half) {
    std::uniform_real_distribution<float> coordinate(-half, half);
    return {coordinate(engine_), coordinate(engine_), coordinate(engine_)};
  }

 private:
  std::mt19937 engine_{7};
};

TEST(Obstacle, DistanceFromABoxASphereAndACapsule) {
  Obstacle box;
  box.kind = ObstacleKind::kBox;
  box.extent = {1, 2, 3};
  EXPECT_FLOAT_EQ(separation(box, {1.5f, 0, 0}).distance, 0.5f);
  EXPECT_FLOAT_EQ(separation(box, {4, 6, 3}).distance, 5);
  EXPECT_FLOAT_EQ(separation(box, {0.75f, 0, 0}).distance, -0.25f);
  EXPECT_EQ(separation(box, {-0.75f, 0, 0}).normal, -Vector3f::UnitX());
  Obstacle sphere;
  sphere.kind = ObstacleKind::kBox;
  sphere.rounding = 2;
  EXPECT_FLOAT_EQ(separation(sphere, {0, 3, 4}).distance, 3);
  EXPECT_TRUE(separation(sphere, {0, 3, 4}).normal.isApprox(Vector3f(0, 0.6f, 0.8f)));
  Obstacle capsule = sphere;
  capsule.extent = {0, 1, 0};
  EXPECT_FLOAT_EQ(separation(capsule, {0, 4, 4}).distance, 3);
  EXPECT_FLOAT_EQ(separation(capsule, {3, 0.5f, 0}).distance, 1);
}

TEST(Obstacle, DistanceFromACylinderAndACone) {
  Obstacle cylinder;
  cylinder.kind = ObstacleKind::kCylinder;
  cylinder.extent = {2, 1, 0};
  EXPECT_FLOAT_EQ(separation(cylinder, {0, 3, 0}).distance, 2);
  EXPECT_FLOAT_EQ(separation(cylinder, {3, 0.5f, 4}).distance, 3);
  EXPECT_FLOAT_EQ(separation(cylinder, {5, 5, 0}).distance, 5);
  EXPECT_FLOAT_EQ(separation(cylinder, {0, 0.25f, 1.5f}).distance, -0.5f);
  Obstacle cone = cylinder;
  cone.kind = ObstacleKind::kCone;
  cone.extent = {1, 1, 0};
  EXPECT_FLOAT_EQ(separation(cone, {0, 2, 0}).distance, 1);
  EXPECT_FLOAT_EQ(separation(cone, {0, -1.5f, 0}).distance, 0.5f);
  // A point on the axis is as far from the slope as from the base where the inscribed circle's centre is.
  const float slope = 2 / std::sqrt(5.0f);
  EXPECT_NEAR(separation(cone, {0, 0, 0}).distance, -0.5f * slope, 1e-6f);
}

/// Wherever one stands, going along the normal by the distance leads to the surface.
TEST(Obstacle, NormalsLeadToTheSurface) {
  RandomPoints random;
  for (const ObstacleKind kind : {ObstacleKind::kBox, ObstacleKind::kCylinder, ObstacleKind::kCone}) {
    Obstacle obstacle;
    obstacle.kind = kind;
    obstacle.extent = {0.8f, 0.6f, 0.5f};
    obstacle.rounding = 0.1f;
    for (int i = 0; i < 1000; ++i) {
      const Vector3f p = random.in_cube(2);
      const Separation s = separation(obstacle, p);
      EXPECT_NEAR(s.normal.norm(), 1, 1e-5f);
      if (s.distance > 0) {
        EXPECT_NEAR(separation(obstacle, p - s.distance * s.normal).distance, 0, 1e-4f);
      }
    }
  }
}

TEST(Obstacle, TurnsAtItsEdgesAndWhereItIsRound) {
  const auto turns = [](ObstacleKind kind, const Vector3f& extent, float rounding, const Vector3f& point) {
    Obstacle obstacle;
    obstacle.kind = kind, obstacle.extent = extent, obstacle.rounding = rounding;
    return may_turn_near(obstacle, point, 0.1f);
  };
  using enum ObstacleKind;
  const Vector3f half(1, 2, 3), none(0, 0, 0);
  EXPECT_FALSE(turns(kPlane, none, 0, {5, 0, 5}));
  EXPECT_FALSE(turns(kBox, half, 0, {0.5f, 2, 1})) << "on a face";
  EXPECT_TRUE(turns(kBox, half, 0, {-0.95f, 2, 1})) << "near an edge of it";
  EXPECT_TRUE(turns(kBox, half, 0.5f, {0.95f, 2.5f, 1})) << "near a rounded edge";
  EXPECT_FALSE(turns(kBox, half, 1.5f, {0.95f, 3.5f, 1})) << "near one that is as round as a large ball";
  EXPECT_TRUE(turns(kBox, none, 0.9f, {0, 0.9f, 0})) << "a ball";
  EXPECT_FALSE(turns(kBox, none, 1.1f, {0, 1.1f, 0})) << "a large ball";
  EXPECT_FALSE(turns(kCylinder, {2, 1, 2}, 0, {2, 0.5f, 0})) << "on the side";
  EXPECT_TRUE(turns(kCylinder, {2, 1, 2}, 0, {2, -0.95f, 0})) << "near a rim";
  EXPECT_FALSE(turns(kCylinder, {2, 1, 2}, 0, {1, 1, 0})) << "on an end";
  EXPECT_TRUE(turns(kCylinder, {0.5f, 1, 0.5f}, 0, {0, 0.5f, 0.5f})) << "on the side of a thin one";
}

/// However many triangles there are: a search finds those whose boxes meet, in their order.
TEST(TriangleBoxes, FindsWhatAPlainLoopFinds) {
  RandomPoints random;
  TriangleBoxes boxes;
  for (const std::size_t count : {1u, 3u, 4u, 15u, 16u, 17u, 64u, 65u, 300u, 50u}) {
    std::vector<std::array<Vector3f, 3>> triangles;
    for (std::size_t t = 0; t < count; ++t) {
      const Vector3f corner = random.in_cube(1);
      triangles.push_back({corner, corner + random.in_cube(0.2f), corner + random.in_cube(0.2f)});
    }
    boxes.place(triangles);
    const auto meets = [&](std::size_t t, const Bounds<3>& box) {
      const auto& [a, b, c] = triangles[t];
      return overlap({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}, box);
    };
    for (int i = 0; i < 100; ++i) {
      const Vector3f at = random.in_cube(1), half = random.in_cube(0.2f).cwiseAbs();
      const Bounds<3> box{at - half, at + half};
      std::vector<std::uint32_t> found, expected;
      boxes.for_each_meeting(box, [&](std::uint32_t t) { found.push_back(t); });
      for (std::uint32_t t = 0; t < count; ++t)
        if (meets(t, box)) expected.push_back(t);
      EXPECT_EQ(found, expected) << count;
    }
    std::size_t next = 0;
    boxes.for_each_block([&](std::size_t first, std::size_t end, const Bounds<3>& box) {
      EXPECT_EQ(first, next);
      EXPECT_LE(end, first + 16);
      for (std::size_t t = first; t < end; ++t) {
        for (const Vector3f& corner : triangles[t]) {
          EXPECT_TRUE(overlap(box, {corner, corner}));
          EXPECT_TRUE(overlap(boxes.bounds(), {corner, corner}));
        }
      }
      next = end;
    });
    EXPECT_EQ(next, count);
  }
}

TEST(CornerSet, HasEachCornerOnceInTheOrderInWhichTheyCame) {
  RandomPoints random;
  CornerSet set;
  for (const std::size_t count : {1000u, 1u, 0u, 37u}) {
    set.begin(3 * count);
    std::vector<CornerSet::Point> expected;
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3f p = random.in_cube(1);
      expected.push_back({p.x(), p.y(), p.z()});
      for (const std::size_t other : {i, i / 2, i}) {
        const auto& [x, y, z] = expected[other];
        set.add(Vector3f(x, y, z));
      }
    }
    EXPECT_TRUE(std::ranges::equal(set.corners(), expected, {}, &CornerSet::Corner::point)) << count;
  }
}

/// A square of quads with heights: which of its corners are flat, in any order of its triangles, turned and moved anyhow.
TEST(CornerSet, KnowsWhichCornersStandOutOfNothing) {
  constexpr int kSide = 7;  // corners
  RandomPoints random;
  std::mt19937 order(1);
  const auto flat_corners = [&](const auto& height) {
    const Eigen::Matrix3f turn =
        Eigen::Quaternionf::FromTwoVectors(random.in_cube(1), random.in_cube(1)).toRotationMatrix();
    const auto at = [&](int i, int j) -> Vector3f {
      return turn * Vector3f(0.1f * static_cast<float>(i), height(i, j), 0.1f * static_cast<float>(j));
    };
    std::vector<CornerSet::Triangle> triangles;
    for (int i = 0; i + 1 < kSide; ++i)
      for (int j = 0; j + 1 < kSide; ++j) {
        triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
        triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      }
    std::shuffle(triangles.begin(), triangles.end(), order);
    CornerSet set;
    set.begin(3 * triangles.size());
    for (const CornerSet::Triangle& triangle : triangles) set.add(triangle);
    EXPECT_EQ(set.corners().size(), std::size_t{kSide * kSide});
    return std::ranges::count_if(set.corners(), &CornerSet::Corner::is_flat);
  };
  constexpr int kInner = (kSide - 2) * (kSide - 2);
  for (int turn = 0; turn < 20; ++turn) {
    EXPECT_EQ(flat_corners([](int, int) { return 0.0f; }), kInner) << "all but those of the border";
    EXPECT_EQ(flat_corners([](int i, int) { return 0.3f * static_cast<float>(i); }), kInner) << "a slope";
    EXPECT_EQ(flat_corners([](int i, int) { return i < 3 ? 0.0f : 0.1f; }), kInner - 2 * (kSide - 2))
        << "a step";
    EXPECT_EQ(flat_corners([](int i, int j) { return i == 3 && j == 3 ? 0.01f : 0.0f; }), kInner - 7)
        << "a point and the six corners that share a triangle with it";
    EXPECT_EQ(flat_corners([](int i, int j) { return 0.01f * static_cast<float>(i * i + j * j); }), 0)
        << "a bowl";
  }
}

/// A hole in a plane has a border; a triangle without an area says nothing of the plane.
TEST(CornerSet, BordersAndTrianglesWithoutAnAreaStandOut) {
  const Vector3f middle(0, 0, 0), around[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  const auto middle_is_flat = [&](int triangles, bool with_a_line) {
    CornerSet set;
    set.begin(15);
    for (int i = 0; i < triangles; ++i) set.add(CornerSet::Triangle{middle, around[i], around[(i + 1) % 4]});
    if (with_a_line) set.add(CornerSet::Triangle{middle, around[0], around[0]});
    return set.corners()[0].is_flat();
  };
  EXPECT_TRUE(middle_is_flat(4, false));
  EXPECT_FALSE(middle_is_flat(3, false));
  EXPECT_FALSE(middle_is_flat(4, true));
}

TEST(EdgeSet, KnowsWhichSidesStandOutOfNothing) {
  // Two triangles of a square, the second one bent up by a height, and perhaps a third one at their common side.
  const auto flat_sides = [](float height, bool wound_alike, bool with_third) {
    const Vector3f a(0, 0, 0), b(1, 0, 0), c(1, 0, -1), d(0, height, -1);
    std::vector<CornerSet::Triangle> triangles = {{a, b, c}};
    triangles.push_back(wound_alike ? CornerSet::Triangle{c, d, a} : CornerSet::Triangle{a, d, c});
    if (with_third) triangles.push_back({a, c, Vector3f(0.5f, 1, -0.5f)});
    EdgeSet set;
    set.begin(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) set.add(t, triangles[t]);
    std::vector<std::size_t> flat;
    for (std::size_t side = 0; side < 3 * triangles.size(); ++side)
      if (set.is_flat(side)) flat.push_back(side);
    return flat;
  };
  const std::vector<std::size_t> none, diagonal = {2, 5};
  EXPECT_EQ(flat_sides(0, true, false), diagonal);
  EXPECT_EQ(flat_sides(0.03f, true, false), diagonal) << "nearly";
  EXPECT_EQ(flat_sides(0.2f, true, false), none) << "bent";
  EXPECT_EQ(flat_sides(0, false, false), none) << "two sides of one sheet, or folded onto itself";
  EXPECT_EQ(flat_sides(0, true, true), none) << "a third one stands on it";
}

TEST(TriangleSheets, AreJoinedBySidesOfTwoTrianglesThatAreWoundAlike) {
  using Triangle = CornerSet::Triangle;
  const Vector3f a(0, 0, 0), b(1, 0, 0), c(1, 0, -1), d(0, 0, -1), e(2, 0, 0), up(1, 1, 0);
  const auto sheets_of = [](const std::vector<Triangle>& triangles) {
    TriangleSheets sheets;
    sheets.find(triangles);
    std::vector<std::uint32_t> all;
    for (std::size_t t = 0; t < triangles.size(); ++t) all.push_back(sheets.of(t));
    EXPECT_EQ(sheets.count(), *std::ranges::max_element(all) + 1u);
    return all;
  };
  using Sheets = std::vector<std::uint32_t>;
  EXPECT_EQ(sheets_of({{a, b, c}, {a, c, d}}), (Sheets{0, 0})) << "a square";
  EXPECT_EQ(sheets_of({{a, b, c}, {a, d, c}}), (Sheets{0, 1})) << "wound against each other";
  EXPECT_EQ(sheets_of({{a, b, c}, {b, e, up}}), (Sheets{0, 1})) << "a corner joins nothing";
  EXPECT_EQ(sheets_of({{a, b, c}, {b, e, c}, {b, up, c}}), (Sheets{0, 1, 2})) << "a wall on a floor's side";
  EXPECT_EQ(sheets_of({{a, b, c}, {a, b, up}, {a, c, d}}), (Sheets{0, 1, 0})) << "in the order of triangles";
  // Around a closed box all are joined, in whatever order they come.
  const TriangleMesh box = make_box({1, 1, 1}, 0.25f);
  std::vector<Triangle> triangles;
  for (const auto& t : box.triangles)
    triangles.push_back({box.positions[t[0]], box.positions[t[1]], box.positions[t[2]]});
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(1));
  EXPECT_EQ(sheets_of(triangles), Sheets(triangles.size(), 0));
}

/// Whoever has seen other triangles before knows the same of these as whoever sees them first.
TEST(KnownTriangles, AreThoseOfTheLastCallWhateverHasChanged) {
  std::vector<CornerSet::Triangle> triangles;
  std::vector<ObstacleEdge> edges;  // none: the sides
  const auto see = [&](KnownTriangles& known, float longest) {
    Obstacle obstacle;
    obstacle.kind = ObstacleKind::kTriangles;
    obstacle.triangles = triangles;
    obstacle.edges = edges;
    known.see(obstacle, longest);
  };
  const Vector3f middle(0, 0, 0), around[] = {{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 0, 1}};
  const auto make_pyramid = [&](float height) {
    triangles.clear();
    edges.clear();
    for (int i = 0; i < 4; ++i)
      triangles.push_back({middle + Vector3f(0, height, 0), around[i], around[(i + 1) % 4]});
  };
  KnownTriangles known;
  const auto expect_what_a_new_one_knows = [&](float longest, std::size_t corners, bool has_long) {
    KnownTriangles fresh;
    see(fresh, longest);
    for (int again = 0; again < 2; ++again) {
      see(known, longest);
      EXPECT_TRUE(std::ranges::equal(known.corners(), fresh.corners()));
      EXPECT_EQ(known.corners().size(), corners);
      EXPECT_EQ(known.has_long_edges(), has_long);
      EXPECT_EQ(known.boxes().bounds().high, fresh.boxes().bounds().high);
      EXPECT_EQ(known.boxes().bounds().low, fresh.boxes().bounds().low);
    }
  };
  make_pyramid(0);
  expect_what_a_new_one_knows(2, 4, false);  // the middle is flat
  make_pyramid(0.1f);
  expect_what_a_new_one_knows(2, 5, false);
  make_pyramid(-0.1f);
  expect_what_a_new_one_knows(2, 5, false);
  make_pyramid(0.015f);
  expect_what_a_new_one_knows(2, 4, false);  // nearly flat
  make_pyramid(-0.1f);
  expect_what_a_new_one_knows(1.2f, 5, true);  // the four along the border are longer
  triangles.resize(1);
  expect_what_a_new_one_knows(2, 3, false);
  edges = {{middle, middle}, {around[0], around[0]}, {middle, middle}};  // as in two dimensions
  expect_what_a_new_one_knows(2, 2, false);
  edges[0].to = 3 * around[1];
  expect_what_a_new_one_knows(2, 2, true);
  make_pyramid(0);
  expect_what_a_new_one_knows(2, 4, false);
}

TEST(KnownTriangles, KnowWhereTrianglesFace) {
  RandomPoints random;
  std::vector<CornerSet::Triangle> triangles;
  for (int i = 0; i < 100; ++i)
    triangles.push_back({random.in_cube(1), random.in_cube(1), random.in_cube(1)});
  triangles.push_back({Vector3f(0, 0, 0), Vector3f(1, 1, 1), Vector3f(2, 2, 2)});
  Obstacle obstacle;
  obstacle.kind = ObstacleKind::kTriangles;
  obstacle.triangles = triangles;
  KnownTriangles known;
  known.see(obstacle, 1);
  for (std::size_t t = 0; t + 1 < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const Vector3f normal = (b - a).cross(c - a).normalized();
    EXPECT_TRUE(known.face(t).normal.isApprox(normal, 1e-5f)) << t;
    EXPECT_NEAR(
        known.face(t).area,
        (b - a).norm() * (c - a).norm() * std::sin(std::acos((b - a).normalized().dot((c - a).normalized()))),
        1e-4f)
        << t;
    EXPECT_EQ(known.boxes().at(t).low, Vector3f(a.cwiseMin(b).cwiseMin(c))) << t;
    EXPECT_EQ(known.boxes().at(t).high, Vector3f(a.cwiseMax(b).cwiseMax(c))) << t;
  }
  EXPECT_EQ(known.face(triangles.size() - 1).area, 0);
}

TEST(Obstacle, SidesOfTrianglesAreEdgesWhereThereAreNoOthers) {
  const std::vector<CornerSet::Triangle> triangles{{Vector3f(0, 0, 0), Vector3f(1, 0, 0), Vector3f(0, 1, 0)},
                                                   {Vector3f(0, 0, 5), Vector3f(1, 0, 5), Vector3f(0, 1, 5)}};
  Obstacle obstacle;
  obstacle.kind = ObstacleKind::kTriangles;
  obstacle.triangles = triangles;
  ASSERT_EQ(obstacle.edge_count(), 6u);
  EXPECT_EQ(obstacle.edge(0).to, Vector3f(1, 0, 0));
  EXPECT_EQ(obstacle.edge(5).from, Vector3f(0, 1, 5));
  EXPECT_EQ(obstacle.edge(5).to, Vector3f(0, 0, 5));
  EXPECT_EQ(bounds(obstacle).high, Vector3f(1, 1, 5));
  const std::vector<ObstacleEdge> others{{Vector3f(0, 0, 0), Vector3f(0, 0, 7)}};
  obstacle.edges = others;
  ASSERT_EQ(obstacle.edge_count(), 1u);
  EXPECT_EQ(obstacle.edge(0).to, Vector3f(0, 0, 7));
}

TEST(Obstacle, ABoxAroundItsPartsIsAroundThemInTheWorld) {
  RandomPoints random;
  for (int i = 0; i < 1000; ++i) {
    Obstacle obstacle;
    obstacle.position = 100 * random.in_cube(1);
    obstacle.rotation =
        Eigen::Quaternionf::FromTwoVectors(random.in_cube(1), random.in_cube(1)).toRotationMatrix();
    const Vector3f a = random.in_cube(1), b = random.in_cube(1);
    const Bounds<3> own{a.cwiseMin(b), a.cwiseMax(b)}, box = to_world(obstacle, own);
    const Vector3f inside = (random.in_cube(0.5f).array() + 0.5f).matrix();
    const Vector3f point = (own.low + inside.cwiseProduct(own.high - own.low)).cwiseMin(own.high);
    for (const Vector3f& p : {point, a, b, own.low, own.high}) {
      const Vector3f there = obstacle.to_world(p);
      EXPECT_TRUE(overlap(box, {there, there})) << i;
    }
  }
}

TEST(TriangleGrid, AgreesWithASphere) {
  const TriangleMesh mesh = make_sphere(1, 24);
  const TriangleGrid grid(mesh, 0.2f);
  RandomPoints random;
  for (int i = 0; i < 500; ++i) {
    const Vector3f p = random.in_cube(1.2f);
    const float distance = p.norm() - 1;
    if (std::abs(distance) < 0.5f) {
      EXPECT_NEAR(grid.signed_distance(p, 0.6f), distance, 0.01f);
    }
  }
}

/// Triangles of every size, from a thousandth of a cube to ten cubes, thin ones and specks: none that is nearest is left out.
TEST(TriangleGrid, FindsTheNearestOfAllTriangles) {
  RandomPoints random;
  TriangleMesh mesh;
  for (std::uint32_t t = 0; t < 300; ++t) {
    const Vector3f corner = random.in_cube(1);
    const float size = std::pow(10.0f, static_cast<float>(t % 5) - 4);
    for (const Vector3f& p : {corner, Vector3f(corner + random.in_cube(size)),
                              Vector3f(corner + random.in_cube(t % 2 == 0 ? size : 0.01f * size))})
      mesh.positions.push_back(p);
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const TriangleGrid grid(mesh, 0.1f);
  for (int i = 0; i < 1000; ++i) {
    // In space, and on the triangles, where the nearest one is at no distance.
    const auto at = static_cast<std::size_t>(i) % mesh.positions.size();
    const Vector3f p = i % 2 == 0 ? random.in_cube(1.5f) : mesh.positions[at];
    float nearest = 1;
    for (const auto& t : mesh.triangles) {
      const Vector3f found =
          nearest_point({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}, p);
      nearest = std::min(nearest, (p - found).norm());
    }
    EXPECT_FLOAT_EQ(std::abs(grid.signed_distance(p, 1)), nearest) << p.transpose();
  }
}

TEST(TriangleGrid, KnowsItsSidesAtEdgesAndCorners) {
  const TriangleMesh mesh = make_box({2, 2, 2}, 1);
  const TriangleGrid grid(mesh, 0.5f);
  EXPECT_NEAR(grid.signed_distance({1.3f, 1.4f, 0}, 2), 0.5f, 1e-6f);
  EXPECT_NEAR(grid.signed_distance({1.2f, 1.2f, 1.1f}, 2), 0.3f, 1e-6f);
  EXPECT_NEAR(grid.signed_distance({0.9f, 0.8f, 0.7f}, 2), -0.1f, 1e-6f);
}

TEST(ContactSurface, ItsFieldIsTheDistanceInCells) {
  constexpr float kCell = 0.1f;
  const TriangleMesh mesh = make_sphere(0.42f, 24);
  const Lattice<3> lattice = voxelize(mesh, kCell);
  const ContactSurface surface(mesh, lattice);
  RandomPoints random;
  for (std::uint32_t cell = 0; cell < lattice.cells.size(); ++cell) {
    const Vector3f xi = random.in_cube(0.5f) + Vector3f::Constant(0.5f);
    const Vector3f p = lattice.origin + kCell * (lattice.cells[cell].cast<float>() + xi);
    const float distance = (p.norm() - 0.42f) / kCell;
    if (distance > -1.5f) {
      EXPECT_NEAR(surface.field(cell, xi).distance, distance, 0.06f);
    }
    EXPECT_LT(surface.field(cell, xi).distance, distance + 0.5f) << "deeper inside counts on";
  }
}

TEST(ContactSurface, ItsGradientIsThatOfTheField) {
  const TriangleMesh mesh = make_penguin(0.9f);
  const Lattice<3> lattice = voxelize(mesh, 0.15f);
  const ContactSurface surface(mesh, lattice);
  RandomPoints random;
  for (std::uint32_t cell = 0; cell < lattice.cells.size(); ++cell) {
    const Vector3f xi = Vector3f::Constant(0.25f) + random.in_cube(0.2f);
    const FieldValue value = surface.field(cell, xi);
    for (int d = 0; d < 3; ++d) {
      const Vector3f by = 0.01f * Vector3f::Unit(d);
      const float slope =
          (surface.field(cell, xi + by).distance - surface.field(cell, xi - by).distance) / 0.02f;
      EXPECT_NEAR(value.gradient[d], slope, 1e-2f);
    }
  }
}

/// At least half a cell deep where the body is thick, in the middle where it is thin, and never two cells away.
TEST(ContactSurface, InnerPlacesAreWellInsideAndNear) {
  constexpr float kCell = 0.1f;
  for (const float thick : {0.8f, 0.1f}) {
    const TriangleMesh mesh = make_box({0.83f, thick, 0.83f}, kCell);
    const Lattice<3> lattice = voxelize(mesh, kCell);
    const std::vector<CellPlace> places = find_inner_places(ContactSurface(mesh, lattice), lattice);
    ASSERT_EQ(places.size(), lattice.cells.size());
    for (std::size_t cell = 0; cell < places.size(); ++cell) {
      const Vector3f at = lattice.cells[places[cell].cell].cast<float>() + places[cell].xi;
      const Vector3f rest = lattice.origin + kCell * at;
      const float depth = std::min(0.5f * thick - std::abs(rest.y()),
                                   0.415f - std::max(std::abs(rest.x()), std::abs(rest.z())));
      EXPECT_GT(depth, 0.4f * std::min(kCell, 0.5f * thick)) << rest.transpose();
      EXPECT_LE((at - lattice.cells[cell].cast<float>() - Vector3f::Constant(0.5f)).cwiseAbs().maxCoeff(),
                1.5f);
    }
  }
}

TEST(ContactSurface, PointsCoverTheMesh) {
  constexpr float kCell = 0.15f;
  for (const TriangleMesh& mesh :
       {make_penguin(0.9f), make_box({1, 0.5f, 0.5f}, 0.5f), make_cone(0.4f, 0.8f, 24)}) {
    const Lattice<3> lattice = voxelize(mesh, kCell);
    const ContactSurface surface(mesh, lattice);
    // What lies within other parts of a penguin touches nothing.
    const TriangleMesh outside = outer_surface(mesh, Solid(mesh), kCell).value_or(mesh);
    for (const auto& t : outside.triangles) {
      const std::array<Vector3f, 3> corners{outside.positions[t[0]], outside.positions[t[1]],
                                            outside.positions[t[2]]};
      const Vector3f normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
      for (const Vector3f& vertex : corners) {
        float nearest = 1e9f, stands_out = 1e9f;
        for (const SurfacePointAtRest& point : surface.points()) {
          const Vector3f off = vertex - point.rest;
          nearest = std::min(nearest, off.norm());
          if (off.norm() < 0.46f * kCell) stands_out = std::min(stands_out, normal.dot(off));
        }
        EXPECT_LT(nearest, 0.46f * kCell) << vertex.transpose();
        EXPECT_LT(stands_out, 2 * PointChooser::kBulge * kCell) << vertex.transpose();
      }
    }
  }
}

/// Two boxes, the first of which ends at x = 0 with its upper side at y = 0; the spacing is 1.
class TwoBoxes {
 public:
  /// @param turned  radians: the second one, about z at the first one's corner
  explicit TwoBoxes(const Vector3f& middle_of_second, float turned = 0) {
    for (Obstacle& box : obstacles_) box.kind = ObstacleKind::kBox, box.extent = {2, 1, 5};
    obstacles_[0].position = {-2, -1, 0};
    obstacles_[1].rotation = Eigen::AngleAxisf(turned, Vector3f::UnitZ()).toRotationMatrix();
    obstacles_[1].position = obstacles_[1].rotation * middle_of_second;
    beside_.begin(obstacles_, kNear, obstacles_[0], 1);
  }
  bool face_goes_on(const Vector3f& point) { return beside_.face_goes_on(point, {0, 0, 3}); }
  /// The way out of a point of the world, by the nearest face.
  std::optional<Separation> way_out(const Vector3f& point) { return way_out(point, point); }
  std::optional<Separation> way_out(const Vector3f& point, const Vector3f& from) {
    return way_out(point, from, from);
  }
  /// @param inside  of the point's body
  std::optional<Separation> way_out(const Vector3f& point, const Vector3f& from, const Vector3f& inside) {
    const Vector3f own = obstacles_[0].to_own(point);
    return beside_.way_out(own, separation(obstacles_[0], own), obstacles_[0].to_own(from),
                           obstacles_[0].to_own(inside));
  }
  /// Whether the first box's side in the plane x = 0, or its upper one in y = 0, is covered. @param place  in the world
  bool is_covered(const Vector3f& place, const Vector3f& normal) {
    return beside_.is_covered(obstacles_[0].to_own(place), normal);
  }

 private:
  static constexpr std::array<std::uint32_t, 2> kNear{0, 1};
  std::array<Obstacle, 2> obstacles_;
  Beside beside_;
};

TEST(Beside, AFaceIsCoveredWhereAnotherShapeIsBehindIt) {
  EXPECT_TRUE(TwoBoxes({2, -1, 0}).is_covered({0, -0.5f, 1}, Vector3f::UnitX()));
  EXPECT_FALSE(TwoBoxes({2, -1, 0}).is_covered({-1, 0, 1}, Vector3f::UnitY())) << "the upper side";
  EXPECT_TRUE(TwoBoxes({2.2f, -1, 0}).is_covered({0, -0.5f, 1}, Vector3f::UnitX())) << "over a small gap";
  EXPECT_FALSE(TwoBoxes({2.3f, -1, 0}).is_covered({0, -0.5f, 1}, Vector3f::UnitX())) << "over a large one";
  EXPECT_FALSE(TwoBoxes({2, -1.7f, 0}).is_covered({0, -0.5f, 1}, Vector3f::UnitX())) << "above a step";
}

TEST(Beside, FlushShapesHaveNoEdgeBetweenThem) {
  EXPECT_TRUE(TwoBoxes({2, -1, 0}).face_goes_on({0, 0, 0}));
  EXPECT_TRUE(TwoBoxes({2, -1.002f, 0}).face_goes_on({0, 0, 1})) << "less than a four-hundredth lower";
  EXPECT_TRUE(TwoBoxes({2.1f, -1, 0}).face_goes_on({0, 0, -1})) << "across a gap";
  EXPECT_TRUE(TwoBoxes({2, 0.5f, 0}).face_goes_on({0, 0, 0})) << "at the foot of a wall";
  EXPECT_TRUE(TwoBoxes({0, -3, 0}).face_goes_on({0, -2, 0})) << "what it stands on";
  EXPECT_TRUE(TwoBoxes({2, -1, 0}, 0.3f).face_goes_on({0, 0, 0})) << "a valley";
  EXPECT_TRUE(TwoBoxes({2, -1, 0}).face_goes_on({0, 0, 5})) << "where the edge ends";
}

TEST(Beside, EdgesThatStandOutStay) {
  EXPECT_FALSE(TwoBoxes({2, -1.05f, 0}).face_goes_on({0, 0, 0})) << "a step";
  EXPECT_FALSE(TwoBoxes({2.3f, -1, 0}).face_goes_on({0, 0, 0})) << "a gap";
  EXPECT_FALSE(TwoBoxes({2, -1, 0}, -0.1f).face_goes_on({0, 0, 0})) << "a ridge";
  EXPECT_FALSE(TwoBoxes({2, -1, 0}, -0.1f).face_goes_on({0, 0, 5})) << "the end of a ridge";
  EXPECT_FALSE(TwoBoxes({2, -1, 0}).face_goes_on({-4, 0, 0})) << "the far edge";
  EXPECT_FALSE(TwoBoxes({2, -1, 8}).face_goes_on({0, 0, 0})) << "the other box begins at z = 3";
}

TEST(Beside, TheWayOutIsNotIntoTheNextShape) {
  // A tenth of a millimetre before the second box, which is nearer than the upper side.
  const Vector3f point(-1e-4f, -0.02f, 0.5f);
  const auto up = TwoBoxes({2, -1, 0}).way_out(point);
  ASSERT_TRUE(up);
  EXPECT_NEAR(up->distance, -0.02f, 1e-6f);
  EXPECT_EQ(up->normal, Vector3f(0, 1, 0));
  EXPECT_TRUE(TwoBoxes({2, -1, 0}).way_out(point, {-1, 1, 0})) << "come from above";
  EXPECT_FALSE(TwoBoxes({2, -1, 0}).way_out(point, {0.5f, -1, 0.5f})) << "come from behind the upper side";
  EXPECT_FALSE(TwoBoxes({4, -1, 0}).way_out(point)) << "nothing is beside it there";
  EXPECT_FALSE(TwoBoxes({2, -1, 0}).way_out({-0.5f, -0.02f, 0.5f})) << "the upper side is the nearest";
  EXPECT_FALSE(TwoBoxes({2, -1, 0}).way_out({-1e-4f, -0.5f, 0.5f})) << "deep within both";
  const Vector3f deep(-1e-4f, -0.5f, 0.5f);
  EXPECT_TRUE(TwoBoxes({2, -1, 0}).way_out(deep, deep, {0, 1, 0})) << "its body is above";
  EXPECT_TRUE(TwoBoxes({2, -1, 0}).way_out(deep, deep, {0, -0.1f, 0})) << "its body is pressed flat";
  EXPECT_FALSE(TwoBoxes({2, -1, 0}).way_out(deep, deep, {0, -0.6f, 0})) << "its body is not above";
  // At the foot of a wall the ground pushes upwards, although the wall is there, too.
  EXPECT_FALSE(TwoBoxes({1.99f, 0.5f, 0}).way_out({-0.005f, -0.002f, 0}));
}

TEST(CellBoxes, MeetWhatTheBoxOfEachCellMeets) {
  RandomPoints random;
  for (const Vector3f& size : {Vector3f(1, 1, 1), Vector3f(1, 0.25f, 0.25f), Vector3f(1.25f, 0.75f, 0.25f)}) {
    const Lattice<3> lattice = voxelize(make_box(size, 0.5f), 0.25f);
    std::vector<Vector3f> begins, ends;
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      begins.push_back(lattice.rest_position(i) + random.in_cube(0.1f));
      ends.push_back(begins.back() + random.in_cube(0.05f));
    }
    CellBoxes boxes;
    boxes.place(lattice, begins, ends);
    for (int trial = 0; trial < 200; ++trial) {
      const Vector3f at = random.in_cube(0.9f);
      const Bounds<3> box{at - Vector3f::Constant(0.1f), at + Vector3f::Constant(0.1f)};
      std::vector<std::uint32_t> expected, met;
      for (std::uint32_t cell = 0; cell < lattice.cells.size(); ++cell) {
        Vector3f low = begins[lattice.corners[cell][0]], high = low;
        for (const std::uint32_t k : lattice.corners[cell]) {
          low = low.cwiseMin(begins[k]).cwiseMin(ends[k]);
          high = high.cwiseMax(begins[k]).cwiseMax(ends[k]);
        }
        EXPECT_EQ(boxes.at(cell).low, low);
        EXPECT_EQ(boxes.at(cell).high, high);
        if (overlap(box, Bounds<3>{low, high})) expected.push_back(cell);
      }
      boxes.for_each_meeting(box, [&](std::uint32_t cell) { met.push_back(cell); });
      EXPECT_EQ(met, expected);
      EXPECT_EQ(boxes.any_meets(box), !expected.empty());
    }
    Vector3f longest = Vector3f::Zero();
    for (std::size_t i = 0; i < begins.size(); ++i)
      longest = longest.cwiseMax((ends[i] - begins[i]).cwiseAbs());
    EXPECT_EQ(boxes.longest_way(), longest);
  }
}

TEST(CellFinder, FindsPlacesInATwistedLattice) {
  const Lattice<3> lattice = voxelize(make_box({1, 1, 1}, 0.5f), 0.25f);
  std::vector<Vector3f> twisted;
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    const Vector3f p = lattice.rest_position(i);
    const Eigen::AngleAxisf turn(0.6f * p.y(), Vector3f::UnitY());
    twisted.push_back(turn * Vector3f(p.x(), 1.3f * p.y(), p.z()) +
                      0.03f * Vector3f(p.z() * p.z(), 0, p.x()));
  }
  CellFinder finder;
  finder.place(lattice, twisted);
  RandomPoints random;
  for (std::uint32_t cell = 0; cell < lattice.cells.size(); ++cell) {
    const Vector3f xi = random.in_cube(0.45f) + Vector3f::Constant(0.5f);
    const Vector3f p = anchor_in_cell(lattice, cell, xi).of(twisted);
    const auto found = finder.find(p, [](std::uint32_t) { return true; });
    ASSERT_TRUE(found);
    EXPECT_EQ(found->cell, cell);
    EXPECT_LT((found->xi - xi).norm(), 1e-3f);
  }
  EXPECT_FALSE(finder.find({3, 0, 0}, [](std::uint32_t) { return true; }));
}

}  // namespace
}  // namespace softcell::ppu
