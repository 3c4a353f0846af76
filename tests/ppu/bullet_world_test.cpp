// Rigid bodies of several shapes, those that the program moves, and hinges, held against what mechanics says.

#include "ppu/bullet/bullet_world.h"

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "ppu/bullet/bullet_vector.h"

namespace softcell::ppu {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kStep = 1.0f / 240;

Vector3f place_of(const BulletWorld& world, std::size_t body) {
  return world.pose(body).topRightCorner<3, 1>();
}

TEST(RigidShapes, HaveTheVolumesOfTheirFormulas) {
  constexpr float kPi = std::numbers::pi_v<float>;
  EXPECT_FLOAT_EQ(volume_of({.kind = RigidShapeKind::kBox, .size = {1, 2, 3}}), 6);
  EXPECT_FLOAT_EQ(volume_of({.kind = RigidShapeKind::kSphere, .radius = 2}), 32 * kPi / 3);
  EXPECT_FLOAT_EQ(volume_of({.kind = RigidShapeKind::kCylinder, .radius = 2, .height = 3}), 12 * kPi);
  EXPECT_FLOAT_EQ(volume_of({.kind = RigidShapeKind::kCapsule, .radius = 1, .height = 5}),
                  3 * kPi + 4 * kPi / 3);
  EXPECT_FLOAT_EQ(volume_of({.kind = RigidShapeKind::kCone, .radius = 1, .height = 3}), kPi);
}

TEST(RigidShapes, LieOnAFloorAsHighAsTheyAre) {
  for (const RigidShapeKind kind : {RigidShapeKind::kBox, RigidShapeKind::kSphere, RigidShapeKind::kCylinder,
                                    RigidShapeKind::kCapsule, RigidShapeKind::kCone}) {
    BulletWorld world;
    world.add_box({20, 1, 20}, 0, {0, -0.5f, 0}, 0.6f);
    const RigidShape shape{.kind = kind, .size = {1, 1.5f, 1}, .radius = 0.4f, .height = 1.5f};
    const float half = kind == RigidShapeKind::kSphere ? 0.4f : 0.75f;
    const std::size_t body = world.add_body({&shape, 1}, {.mass = 2, .position = {0, half + 0.02f, 0}});
    for (int i = 0; i < 120; ++i) world.step(kStep, 1);
    EXPECT_NEAR(place_of(world, body).y(), half, 0.01f) << static_cast<int>(kind);
  }
}

TEST(RigidShapes, OfNoSizeAreRefused) {
  BulletWorld world;
  const auto add = [&](const RigidShape& shape, const RigidBodySettings& settings = {.mass = 1}) {
    world.add_body({&shape, 1}, settings);
  };
  EXPECT_THROW(add({.size = {1, 0, 1}}), std::invalid_argument);
  EXPECT_THROW(add({.kind = RigidShapeKind::kSphere, .radius = 0}), std::invalid_argument);
  EXPECT_THROW(add({.kind = RigidShapeKind::kCone, .height = NAN}), std::invalid_argument);
  EXPECT_THROW(add({.kind = RigidShapeKind::kCapsule, .radius = 0.5f, .height = 1}), std::invalid_argument);
  EXPECT_THROW(add({}, {.mass = -1}), std::invalid_argument);
  EXPECT_THROW(add({}, {.mass = 1, .is_moved = true}), std::invalid_argument);
  EXPECT_THROW(add({}, {.rotation = Quaternionf(2, 0, 0, 0)}), std::invalid_argument);
  EXPECT_THROW(world.add_body({}, {}), std::invalid_argument);
}

/// Two cubes beside each other are one box: the same inertia, and the same place, also when their frame is not in their middle.
TEST(Compounds, OfTwoCubesAreABox) {
  BulletWorld world;
  const std::array<RigidShape, 2> cubes{RigidShape{.size = {1, 1, 1}, .position = {1.5f, 2, 0}},
                                        RigidShape{.size = {1, 1, 1}, .position = {2.5f, 2, 0}}};
  const Quaternionf turned(AngleAxisf(0.7f, Vector3f(1, 2, 3).normalized()));
  const std::size_t body = world.add_body(cubes, {.mass = 6, .position = {0, 5, 0}, .rotation = turned});
  EXPECT_LT((place_of(world, body) - Vector3f(0, 5, 0)).norm(), 1e-5f);
  const btRigidBody& rigid = world.rigid_body(body);
  const Vector3f centre = Vector3f(0, 5, 0) + turned * Vector3f(2, 2, 0);
  EXPECT_LT((to_eigen(rigid.getCenterOfMassPosition()) - centre).norm(), 1e-5f);
  // 1/12 m (a^2 + b^2)
  Eigen::Matrix3f inertia = Vector3f(1.0f, 2.5f, 2.5f).asDiagonal();
  inertia = turned.toRotationMatrix() * inertia * turned.toRotationMatrix().transpose();
  EXPECT_LT((to_eigen(rigid.getInvInertiaTensorWorld()) - inertia.inverse()).norm(), 1e-3f);
}

TEST(MovedBodies, AreWhereTheProgramPutsThemAndCarryWhatLiesOnThem) {
  BulletWorld world;
  const RigidShape plate{.size = {2, 0.2f, 2}}, cube{.size = {0.4f, 0.4f, 0.4f}};
  const std::size_t lift = world.add_body({&plate, 1}, {.position = {0, 0, 0}, .is_moved = true});
  const std::size_t load = world.add_body({&cube, 1}, {.mass = 3, .position = {0, 0.3f, 0}});
  for (int i = 1; i <= 240; ++i) {
    const float way = static_cast<float>(i) / 240;
    world.move_to(lift, {0.5f * way, way, 0}, Quaternionf(AngleAxisf(0.5f * way, Vector3f::UnitY())));
    world.step(kStep, 1);
    ASSERT_LT((place_of(world, lift) - Vector3f(0.5f * way, way, 0)).norm(), 1e-5f);
  }
  EXPECT_LT((place_of(world, load) - Vector3f(0.5f, 1.3f, 0)).norm(), 0.05f) << place_of(world, load);
  const Vector3f x = world.pose(load).topLeftCorner<3, 1>();
  EXPECT_NEAR(std::atan2(-x.z(), x.x()), 0.5f, 0.05f);
  world.reset();
  world.step(kStep, 1);
  EXPECT_LT(place_of(world, lift).norm(), 1e-6f) << "it stays where it was at first";
}

TEST(Hinges, KeepTheirPointAndTheirAxis) {
  BulletWorld world;
  const RigidShape bar{.size = {1, 0.1f, 0.1f}};
  const std::size_t post = world.add_body({&bar, 1}, {.position = {-0.5f, 2, 0}});
  const std::size_t pendulum = world.add_body({&bar, 1}, {.mass = 2, .position = {0.5f, 2, 0}});
  world.add_hinge({.a = post, .b = pendulum, .point = {0, 2, 0}, .axis = Vector3f::UnitZ()});
  float lowest = 2;
  for (int i = 0; i < 480; ++i) {
    world.step(kStep, 1);
    ASSERT_NEAR((place_of(world, pendulum) - Vector3f(0, 2, 0)).norm(), 0.5f, 0.01f);
    ASSERT_NEAR(place_of(world, pendulum).z(), 0, 1e-3f);
    lowest = std::min(lowest, place_of(world, pendulum).y());
  }
  EXPECT_NEAR(lowest, 1.5f, 0.01f);
}

/// A wheel of inertia I under a torque T turns by T t / I, and no faster than its motor wants.
TEST(Motors, TurnWithTheirTorqueUpToTheirSpeed) {
  BulletWorld world;
  world.set_gravity({0, 0, 0});
  const RigidShape block{}, disc{.kind = RigidShapeKind::kCylinder, .radius = 1, .height = 0.2f};
  const std::size_t frame = world.add_body({&block, 1}, {});
  const std::size_t wheel = world.add_body({&disc, 1}, {.mass = 8});  // about its axis 1/2 m r^2 = 4 kg m^2
  world.add_hinge({.a = frame, .b = wheel, .axis = Vector3f::UnitY(), .speed = 3, .torque = 6});
  const auto spin = [&] { return world.rigid_body(wheel).getAngularVelocity().y(); };
  for (int i = 0; i < 240; ++i) world.step(kStep, 1);
  EXPECT_NEAR(spin(), 1.5f, 0.02f);
  for (int i = 0; i < 480; ++i) world.step(kStep, 1);
  EXPECT_NEAR(spin(), 3, 0.02f);
}

}  // namespace
}  // namespace softcell::ppu
