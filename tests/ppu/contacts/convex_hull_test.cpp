// The hull that stands for a convex shape of Bullet touches each side of the shape, and does not leave it.
#include "ppu/bullet/convex_hull.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btMinkowskiSumShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTetrahedronShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "ppu/bullet/bullet_vector.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// A ball of many corners, and Bullet's shapes of it.
class ABall : public testing::Test {
 protected:
  static constexpr float kRadius = 3;
  ABall() {
    for (const Vector3f& corner : ball_.positions) corners_.push_back(to_bullet(corner));
    for (const auto& t : ball_.triangles) mesh_.addTriangle(corners_[t[0]], corners_[t[1]], corners_[t[2]]);
  }
  TriangleMesh ball_ = make_sphere(kRadius, 8);
  std::vector<btVector3> corners_;
  btTriangleMesh mesh_;
};

/// How far a shape reaches beyond each face of its hull. @return  the least and the most, metres
std::pair<float, float> beyond(const btConvexShape& shape, const ConvexHull& hull) {
  std::pair<float, float> range{1e9f, -1e9f};
  for (const Eigen::Vector4f& plane : hull.planes()) {
    const Vector3f normal = plane.head<3>();
    const float reach = normal.dot(to_eigen(shape.localGetSupportingVertexWithoutMargin(to_bullet(normal))));
    range.first = std::min(range.first, reach - plane.w());
    range.second = std::max(range.second, reach - plane.w());
  }
  return range;
}

TEST_F(ABall, HasAllCornersInEveryClassOfPolyhedra) {
  btConvexTriangleMeshShape of_triangles(&mesh_);
  btConvexPointCloudShape of_points(corners_.data(), static_cast<int>(corners_.size()), {1, 1, 1});
  btConvexHullShape of_corners(&corners_.front().x(), static_cast<int>(corners_.size()));
  constexpr float kBullets = 3e-4f * kRadius;  // Bullet finds hulls with coordinates of 14 bits
  ConvexHull expected;
  expected.follow(of_corners);
  ASSERT_GT(expected.planes().size(), 300u);
  for (btConvexShape* const shape : std::initializer_list<btConvexShape*>{&of_triangles, &of_points}) {
    ConvexHull hull;
    hull.follow(*shape);
    EXPECT_EQ(hull.planes().size(), expected.planes().size()) << shape->getName();
    const auto [least, most] = beyond(of_corners, hull);
    EXPECT_NEAR(least, 0, kBullets) << shape->getName();
    EXPECT_NEAR(most, 0, kBullets) << shape->getName();
  }
}

TEST_F(ABall, FollowsItsScaling) {
  btConvexTriangleMeshShape of_triangles(&mesh_);
  btConvexPointCloudShape of_points(corners_.data(), static_cast<int>(corners_.size()), {1, 1, 1});
  const btScalar radii[] = {kRadius, 1};
  const btVector3 centres[] = {{0, 0, 0}, {0, 0, 4}};
  btMultiSphereShape of_spheres(centres, radii, 2);
  for (btConvexShape* const shape :
       std::initializer_list<btConvexShape*>{&of_triangles, &of_points, &of_spheres}) {
    ConvexHull hull;
    const auto height = [&] {
      hull.follow(*shape);
      float most = 0;
      for (const Eigen::Vector4f& plane : hull.planes()) most = std::max(most, plane.w() * plane.y());
      return most;
    };
    const float before = height();
    EXPECT_NEAR(before, kRadius, 0.02f * kRadius) << shape->getName();
    shape->setLocalScaling({2, 2, 2});
    EXPECT_NEAR(height(), 2 * before, 1e-3f * before) << shape->getName();
    shape->setLocalScaling({1, 1, 1});
    EXPECT_NEAR(height(), before, 1e-3f * before) << shape->getName();
  }
}

TEST(ConvexHull, OfATetrahedronHasFourFaces) {
  btBU_Simplex1to4 tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  ConvexHull hull;
  hull.follow(tetrahedron);
  EXPECT_EQ(hull.planes().size(), 4u);
}

void expect_nearly(const btConvexShape& shape, float half_length) {
  ConvexHull hull;
  hull.follow(shape);
  EXPECT_GT(hull.planes().size(), 100u);
  EXPECT_LT(hull.planes().size(), 4000u);
  for (const Eigen::Vector4f& plane : hull.planes()) {
    const Vector3f normal = plane.head<3>();
    const float reach = normal.dot(to_eigen(shape.localGetSupportingVertex(to_bullet(normal))));
    EXPECT_GT(reach - plane.w(), -3e-4f * half_length);
    EXPECT_LT(reach - plane.w(), 1.1f * ConvexHull::kTolerance * half_length);
  }
}

TEST(ConvexHull, OfARoundShapeIsNearlyAsRound) {
  const btVector3 centres[] = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0.5f}};
  const btScalar radii[] = {1, 0.5f, 0.8f};
  expect_nearly(btMultiSphereShape(centres, radii, 3), 1.75f);
  const btScalar large[] = {1000, 500, 800};
  expect_nearly(btMultiSphereShape(centres, large, 3), 1001);
  const btBoxShape box({1, 1, 1});
  const btSphereShape ball(0.5f);
  expect_nearly(btMinkowskiSumShape(&box, &ball), 1.5f);
}

TEST(ConvexHull, OneSphereOrTwoOfOneSizeAreASphereOrACapsule) {
  const btVector3 centres[] = {{1, 2, 3}, {1, 2, 7}};
  const btScalar same[] = {0.5f, 0.5f}, different[] = {0.5f, 0.6f};
  btMultiSphereShape capsule(centres, same, 2);
  const btMultiSphereShape sphere(centres, same, 1), cone(centres, different, 2);
  EXPECT_FALSE(is_sphere_or_capsule(cone));
  ASSERT_TRUE(is_sphere_or_capsule(sphere));
  ASSERT_TRUE(is_sphere_or_capsule(capsule));

  Obstacle obstacle;
  set_sphere_or_capsule(sphere, obstacle);
  EXPECT_TRUE(obstacle.position.isApprox(Vector3f(1, 2, 3)));
  EXPECT_EQ(obstacle.extent, Vector3f::Zero());
  EXPECT_EQ(obstacle.rounding, 0.5f);

  capsule.setLocalScaling({2, 2, 2});
  obstacle = {};
  obstacle.rotation = Eigen::AngleAxisf(1.0f, Vector3f::UnitX()).toRotationMatrix();
  const Eigen::Matrix3f turn = obstacle.rotation;
  set_sphere_or_capsule(capsule, obstacle);
  for (const float end : {-1.0f, 1.0f})
    EXPECT_NEAR(
        (obstacle.to_world({0, end * obstacle.extent.y(), 0}) - turn * Vector3f(2, 4, 10 + 4 * end)).norm(),
        0, 1e-4f);
  EXPECT_EQ(obstacle.rounding, 1);
  capsule.setLocalScaling({1, 2, 1});
  EXPECT_FALSE(is_sphere_or_capsule(capsule)) << "an ellipsoid's hull";
}

}  // namespace
}  // namespace softcell::ppu
