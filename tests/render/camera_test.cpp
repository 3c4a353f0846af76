#include "softcell/render/camera.h"

#include <gtest/gtest.h>

namespace softcell::render {
namespace {

Eigen::Vector3f project(const Eigen::Matrix4f& matrix, const Eigen::Vector3f& point) {
  const Eigen::Vector4f clip = matrix * Eigen::Vector4f(point.x(), point.y(), point.z(), 1);
  return clip.head<3>() / clip.w();
}

void expect_near(const Eigen::Vector3f& actual, const Eigen::Vector3f& expected) {
  EXPECT_LT((actual - expected).norm(), 1e-5f)
      << actual.transpose() << " instead of " << expected.transpose();
}

TEST(LookAt, PutsTheTargetStraightAheadAndUpAbove) {
  const Eigen::Matrix4f view = look_at({3, 1, 0}, {1, 1, 0}, {0, 1, 0});
  const auto seen = [&](float x, float y, float z) -> Eigen::Vector3f {
    return (view * Eigen::Vector4f(x, y, z, 1)).head<3>();
  };
  expect_near(seen(1, 1, 0), {0, 0, -2});
  expect_near(seen(3, 2, 0), {0, 1, 0});
  expect_near(seen(3, 1, -1), {1, 0, 0});  // looking along -x, right is -z
}

TEST(Perspective, MapsTheEdgesOfTheViewToTheEdgesOfTheCube) {
  const Eigen::Matrix4f projection = perspective(0.5f, 2, 1, 10);
  expect_near(project(projection, {1, 0.5f, -1}), {1, 1, -1});
  expect_near(project(projection, {-10, -5, -10}), {-1, -1, 1});
}

TEST(Orthographic, MapsItsBoxToTheCube) {
  const Eigen::Matrix4f projection = orthographic(4, 1, 5);
  expect_near(project(projection, {4, -4, -1}), {1, -1, -1});
  expect_near(project(projection, {0, 2, -5}), {0, 0.5f, 1});
}

}  // namespace
}  // namespace softcell::render
