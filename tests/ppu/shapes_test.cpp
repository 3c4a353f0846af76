#include "softcell/soft_bodies/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/mesh_checks.h"
#include "ppu/numbers/deterministic_math.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {
namespace {

struct Shape {
  const char* name;
  std::function<TriangleMesh()> make;
  Eigen::Vector3f size;  ///< of its box, metres
  double least_cosine;   ///< between a triangle's normal and its vertices'
  std::uint64_t hash;    ///< of every bit, the same for every compiler and configuration
};

const Eigen::Vector3f kBoxSize(1, 0.5f, 2), kWedgeSize(2, 0.5f, 1);

const Shape kShapes[] = {
    {"sphere", [] { return make_sphere(0.5f, 12); }, {1, 1, 1}, 0.98, 0x79ba289d47e6eed9u},
    {"torus", [] { return make_torus(0.4f, 0.15f, 48, 24); }, {1.1f, 0.3f, 1.1f}, 0.98, 0xf00fe81c18bdb44du},
    {"box", [] { return make_box(kBoxSize, 0.1f); }, kBoxSize, 0.9999, 0xeaa1ac282c499a58u},
    {"car", [] { return make_car(1); }, {1, 1.26f, 0.64f}, 0.5, 0xd1b32eb6ae719811u},
    {"penguin", [] { return make_penguin(1); }, {0.71f, 1, 0.56f}, 0.5, 0x8ec7071c36589cfcu},
    {"cone", [] { return make_cone(0.5f, 2, 32); }, {1, 2, 1}, 0.9, 0x9b404c04d2d715b6u},
    {"cylinder", [] { return make_cylinder(0.5f, 2, 32); }, {1, 2, 1}, 0.99, 0xbd8067e22e45e33fu},
    {"capsule", [] { return make_capsule(0.5f, 2, 32); }, {1, 2, 1}, 0.97, 0x5b94c86763d70d41u},
    {"rounded_box",
     [] {
       return make_rounded_box({1, 0.5f, 2}, 12);
     },
     {1, 0.5f, 2},
     0.9,
     0x61901c6689dd6d48u},
    {"marked_cells",
     [] {
       return make_marked_cells(0.5f, {0.2f, 0.7f, 0.5f});
     },
     {1, 0.5f, 0.5f},
     0.97,
     0xbb7c19c1406ee45u},
    {"wedge", [] { return make_wedge(kWedgeSize); }, kWedgeSize, 0.9999, 0x723a5b31e10ae042u},
};

std::ostream& operator<<(std::ostream& out, const Shape& shape) { return out << shape.name; }

class Shapes : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(All, Shapes, testing::ValuesIn(kShapes),
                         [](const auto& shape) { return shape.param.name; });

TEST_P(Shapes, IsClosedAndWoundOutwards) {
  const TriangleMesh mesh = GetParam().make();
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_GT(volume(mesh), 0.0);
}

TEST_P(Shapes, HasUnitNormalsThatPointOutwards) {
  const TriangleMesh mesh = GetParam().make();
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const Eigen::Vector3f& normal : mesh.normals) ASSERT_NEAR(normal.cast<double>().norm(), 1.0, 1e-6);
  EXPECT_GT(worst_normal_cosine(mesh), GetParam().least_cosine);
}

TEST_P(Shapes, IsCentredAndAsLargeAsAsked) {
  const Bounds<3> box = bounds(GetParam().make());
  EXPECT_LT((box.low + box.high).cwiseAbs().maxCoeff(), 1e-6f);
  EXPECT_LT((box.high - box.low - GetParam().size).cwiseAbs().maxCoeff(), 0.01f)
      << (box.high - box.low).transpose();
}

TEST_P(Shapes, HasTheSameBitsEverywhere) { EXPECT_EQ(hash(GetParam().make()), GetParam().hash); }

TEST(Sphere, LiesOnItsRadius) {
  for (const Eigen::Vector3f& p : make_sphere(2.5f, 9).positions)
    ASSERT_NEAR(p.cast<double>().norm(), 2.5, 1e-6);
}

TEST(Torus, KeepsItsTubeRadius) {
  for (const Eigen::Vector3f& p : make_torus(2, 0.5f, 20, 15).positions) {
    const double from_ring = std::hypot(
        std::hypot(static_cast<double>(p.x()), static_cast<double>(p.z())) - 2, static_cast<double>(p.y()));
    ASSERT_NEAR(from_ring, 0.5, 1e-6);
  }
}

TEST(Torus, HasATubeSmallerThanItsRing) {
  for (const auto& [minor, said] : {std::pair(1.0f, "1"), std::pair(2.0f, "2")}) {
    try {
      make_torus(1, minor, 8, 8);
      ADD_FAILURE() << minor;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), std::string("a torus's minor radius is ") + said +
                                  "; it must be less than its major radius, 1");
    }
  }
}

TEST(MarkedCells, FillTwoCellsOfALatticeAndNoMore) {
  const Eigen::Vector3f ball(0.2f, 0.7f, 0.5f);
  const TriangleMesh mesh = make_marked_cells(0.5f, ball);
  const Lattice<3> lattice = voxelize(mesh, 0.5f);
  EXPECT_EQ(lattice.cells.size(), 2u);
  EXPECT_EQ(lattice.particles.size(), 12u);
  // The ball's middle is where it was asked for: its vertices lie around it.
  const Eigen::Vector3f middle = lattice.rest_position(0) + 0.5f * ball;
  const auto near = std::count_if(mesh.positions.begin(), mesh.positions.end(), [&](const auto& p) {
    return std::abs((p - middle).norm() - 0.045f) < 1e-5f;
  });
  EXPECT_EQ(near, static_cast<std::ptrdiff_t>(make_sphere(0.045f, 6).positions.size()));
}

TEST(Volumes, ApproachTheirFormulas) {
  EXPECT_NEAR(volume(make_sphere(1, 40)), 4.0 / 3 * kPi, 0.01);
  EXPECT_NEAR(volume(make_torus(2, 0.5f, 200, 100)), 2 * kPi * 2 * kPi * 0.25, 0.01);
  EXPECT_NEAR(volume(make_box({1, 2, 3}, 0.3f)), 6.0, 1e-5);
  EXPECT_NEAR(volume(make_cone(1, 3, 200)), kPi, 0.01);
  EXPECT_NEAR(volume(make_capsule(1, 3, 200)), 4.0 / 3 * kPi + kPi, 0.01);
  EXPECT_NEAR(volume(make_wedge({1, 2, 3})), 3.0, 1e-6);
}

TEST(Car, HasAnAntennaAsHighAsTheCarIsLong) {
  const TriangleMesh car = make_car(2);
  const float top = bounds(car).high.y();
  Eigen::Vector3f low = Eigen::Vector3f::Constant(10), high = -low;
  for (const Eigen::Vector3f& p : car.positions) {
    if (p.y() < top - 1.2f || p.y() > top - 0.3f) continue;  // the mast: above seat and hull, below the knob
    low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  EXPECT_NEAR(high.x() - low.x(), 0.08f, 0.002f);
  EXPECT_NEAR(high.z() - low.z(), 0.08f, 0.003f);
  EXPECT_LT(high.x(), -0.5f);  // at the rear
}

TEST(Penguin, LooksTowardsZAndIsTheSameOnBothSides) {
  const TriangleMesh penguin = make_penguin(2);
  const Bounds<3> box = bounds(penguin);
  const auto foremost = std::max_element(penguin.positions.begin(), penguin.positions.end(),
                                         [](const auto& a, const auto& b) { return a.z() < b.z(); });
  EXPECT_GT(foremost->y(), 0.5f * box.high.y());  // the beak
  EXPECT_NEAR(box.low.x(), -box.high.x(), 1e-6f);
}

TEST(Shapes, RefuseSizesThatMakeNoShape) {
  EXPECT_THROW(make_sphere(0, 4), std::invalid_argument);
  EXPECT_THROW(make_sphere(NAN, 4), std::invalid_argument);
  EXPECT_THROW(make_sphere(1, 0), std::invalid_argument);
  EXPECT_THROW(make_torus(1, -1, 8, 8), std::invalid_argument);
  EXPECT_THROW(make_torus(1, 0.5f, 2, 8), std::invalid_argument);
  EXPECT_THROW(make_box({1, 1, 0}, 0.1f), std::invalid_argument);
  EXPECT_THROW(make_box({1, 1, 1}, 1e-9f), std::invalid_argument);
  EXPECT_THROW(make_car(INFINITY), std::invalid_argument);
  EXPECT_THROW(make_cone(1, 1, 2), std::invalid_argument);
  EXPECT_THROW(make_capsule(0.5f, 1, 16), std::invalid_argument);
  EXPECT_THROW(make_rounded_box({1, 0, 1}, 16), std::invalid_argument);
  EXPECT_THROW(make_penguin(0), std::invalid_argument);
  EXPECT_THROW(make_marked_cells(0, {0.5f, 0.5f, 0.5f}), std::invalid_argument);
  EXPECT_THROW(make_marked_cells(1, {0.5f, 0.5f, 0.95f}), std::invalid_argument);
  EXPECT_THROW(make_marked_cells(1, {0.5f, NAN, 0.5f}), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::ppu
