// Rigid bodies of several parts, bodies that the scene moves, joints and ropes: how they are read, and what they do.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <variant>

#include "scene/rigid_body.h"
#include "scene/scene_hash.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;

constexpr float kPi = std::numbers::pi_v<float>;

Scene scene_of(const std::string& text) { return std::get<Scene>(parse_scene(text, "s.toml")); }

std::string refusal(const std::string& text) {
  try {
    parse_scene(text, "s.toml");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(RigidBodies, AreReadWithTheirPartsAndMotions) {
  const Scene scene = scene_of(R"(
[[rigid_body]]
name = "wheel"
shape = { kind = "cylinder", radius = 0.4, height = 0.2 }
mass = 3
position = [1, 2, 3]
rotation = { axis = [1, 0, 0], degrees = 90 }
colour = "#FFFFFF"
friction = 1.25
[[rigid_body]]
opacity = 0.5
parts = [
  { kind = "box", size = [1, 2, 3], position = [0, 1, 0], colour = "#FF0000" },
  { kind = "capsule", radius = 0.2, height = 1, rotation = { axis = [0, 0, 1], degrees = 90 } },
]
motion = { axis = [0, 0, 2], spin = 3, swing = [0, 0.5, 0], period = 4, stops = [{ time = 1, degrees = 90 }, { time = 2, offset = [1, 0, 0] }] }
[[joint]]
a = "rigid body 2"
b = "wheel"
point = [1, 0, 0]
axis = [0, 5, 0]
speed = 2
torque = 7
)");
  ASSERT_EQ(scene.rigid_bodies.size(), 2u);
  const RigidBody& wheel = scene.rigid_bodies[0];
  EXPECT_EQ(wheel.name, "wheel");
  EXPECT_EQ(wheel.mass, 3);
  EXPECT_EQ(wheel.friction, 1.25f);
  ASSERT_EQ(wheel.parts.size(), 1u);
  EXPECT_EQ(wheel.parts[0].shape.kind, ppu::RigidShapeKind::kCylinder);
  EXPECT_EQ(wheel.parts[0].shape.radius, 0.4f);
  EXPECT_EQ(wheel.parts[0].colour, render::srgb(0xFFFFFF));
  EXPECT_FALSE(wheel.motion);
  const RigidBody& other = scene.rigid_bodies[1];
  ASSERT_EQ(other.parts.size(), 2u);
  EXPECT_EQ(other.parts[0].shape.position, Vector3f(0, 1, 0));
  EXPECT_EQ(other.parts[1].shape.kind, ppu::RigidShapeKind::kCapsule);
  EXPECT_NEAR(other.parts[1].shape.rotation.z(), std::sqrt(0.5f), 1e-6f);
  ASSERT_TRUE(other.motion);
  EXPECT_EQ(other.motion->axis, Vector3f(0, 0, 1));
  ASSERT_EQ(other.motion->stops.size(), 2u);
  EXPECT_NEAR(other.motion->stops[0].angle, kPi / 2, 1e-6f);
  ASSERT_EQ(scene.joints.size(), 1u);
  EXPECT_EQ(scene.joints[0].a, 1u);
  EXPECT_EQ(scene.joints[0].b, 0u);
  EXPECT_EQ(scene.joints[0].axis, Vector3f(0, 1, 0));
  EXPECT_EQ(scene.joints[0].torque, 7);
}

TEST(RigidBodies, AreRefusedWithASentence) {
  const std::string body = "[[rigid_body]]\nname = \"a\"\n", shape = "shape = { kind = \"box\" }\n";
  const auto says = [](const std::string& text, const std::string& sentence) {
    const std::string said = refusal(text);
    EXPECT_NE(said.find(sentence), std::string::npos) << "'" << said << "' in place of '" << sentence << "'";
  };
  says(body, "rigid body 1 ('a') needs either a shape or parts");
  says(body + shape + "parts = [{ kind = \"box\" }]\n", "needs either a shape or parts");
  says(body + "shape = { kind = \"torus\" }\n", "it must be one of box, sphere, cylinder, capsule, cone");
  says(body + "shape = { radius = 1 }\n", "needs the field 'kind'");
  says(body + "shape = { kind = \"box\", radius = 1 }\n", "has no field 'radius'");
  says(body + "shape = { kind = \"capsule\", radius = 1, height = 1.5 }\n",
       "it must be more than twice its radius, 1");
  says(body + shape + "mass = 1\nmotion = { spin = 1 }\n", "has both mass and motion");
  says(body + shape + "motion = { axis = [0, 0, 0] }\n",
       "axis of the motion of rigid body 1 ('a') must not be 0");
  says(body + shape + "motion = { stops = [{ time = 2 }, { time = 2 }] }\n", "each must be later");
  says(body + shape + body + shape, "have the same name, 'a'");
  const std::string two =
      body + shape + "[[rigid_body]]\nname = \"b\"\n" + shape + "[[joint]]\npoint = [0, 0, 0]\n";
  says(two + "a = \"a\"\nb = \"c\"\n", "there is no rigid body 'c'");
  says(two + "a = \"a\"\nb = \"a\"\n", "joint 1 joins a rigid body to itself");
  says(two + "a = \"a\"\nb = \"b\"\n", "joint 1 joins two bodies without a mass");
  says(two + "a = \"a\"\n", "'b'");
}

TEST(Motions, AreWhatTheirFormulasSay) {
  RigidBody body;
  body.position = {1, 2, 3};
  body.motion =
      Motion{.axis = {0, 0, 1},
             .spin = 2,
             .swing = {0, 0.5f, 0},
             .period = 4,
             .stops = {{.time = 2, .offset = {1, 0, 0}, .angle = 1}, {.time = 3, .offset = {1, 0, 5}}}};
  const auto at = [&](double time) { return placement_at(body, time); };
  EXPECT_LT((at(0).position - Vector3f(1, 2, 3)).norm(), 1e-6f);
  EXPECT_LT((at(1).position - Vector3f(1.5f, 2.5f, 3)).norm(), 1e-6f)
      << "half way to the stop, a quarter of the swing";
  EXPECT_LT((at(2).position - Vector3f(2, 2, 3)).norm(), 1e-6f);
  EXPECT_LT((at(7).position - Vector3f(2, 1.5f, 8)).norm(), 1e-6f) << "past the last stop";
  EXPECT_NEAR(at(1).rotation.angularDistance(Eigen::Quaternionf(Eigen::AngleAxisf(2.5f, Vector3f::UnitZ()))),
              0, 1e-3f);
  // At rest at a stop.
  EXPECT_NEAR((at(2.001).position - at(2).position).z(), 0, 1e-4f);
}

TEST(SceneHashOf, AMotionCountsAndWhatIsNotThereDoesNot) {
  Scene scene, other;
  EXPECT_EQ(scene_hash(scene), scene_hash(other));
  scene.rigid_bodies.resize(1);
  scene.rigid_bodies[0].parts.resize(1);
  other.rigid_bodies = scene.rigid_bodies;
  EXPECT_NE(scene_hash(scene), scene_hash(Scene()));
  other.rigid_bodies[0].name = "b";
  other.rigid_bodies[0].parts[0].colour = {1, 0, 0};
  EXPECT_EQ(scene_hash(scene), scene_hash(other)) << "names and colours are looks";
  other.rigid_bodies[0].motion = Motion{};
  EXPECT_NE(scene_hash(scene), scene_hash(other));
}

/// A conveyor: a turning roller carries a soft box along its upper side.
TEST(MovedBodies, TakeSoftBodiesWithThemAndStartAgainAfterAReset) {
  const Scene scene = scene_of(R"(
world = { substeps = 4, friction = 1 }
[[rigid_body]]
name = "plate"
shape = { kind = "box", size = [4, 0.2, 2] }
position = [0, -0.1, 0]
motion = { stops = [{ time = 1, offset = [0.8, 0.3, 0] }] }
[[soft_body]]
cell_size = 0.2
friction = 1
shape = { kind = "box", size = [0.6, 0.4, 0.6] }
above = 0
[[reset]]
time = 1.5
)");
  Simulation3d simulation(scene, {.spes = 2});
  for (int frame = 0; frame < 85; ++frame) simulation.step();
  const Vector3f carried = simulation.soft_body(0).centre_of_mass();
  EXPECT_NEAR(carried.x(), 0.8f, 0.1f);
  EXPECT_NEAR(carried.y(), 0.5f, 0.05f);
  simulation.finish();
  EXPECT_LT((simulation.shown_box_poses()[0].topRightCorner<3, 1>() - Vector3f(0.8f, 0.2f, 0)).norm(), 1e-5f);
  for (int frame = 85; frame < 92; ++frame) simulation.step();
  simulation.finish();
  EXPECT_LT(simulation.shown_box_poses()[0](0, 3), 0.1f) << "it begins again";
  EXPECT_LT(simulation.soft_body(0).centre_of_mass().x(), 0.1f);
}

TEST(Ropes, AreShownWhereTheyHoldUntilTheyBreak) {
  const Scene scene = scene_of(R"(
[[rigid_body]]
name = "hook"
shape = { kind = "box", size = [0.2, 0.2, 0.2] }
position = [0, 3, 0]
[[soft_body]]
name = "lamp"
cell_size = 0.2
shape = { kind = "box", size = [0.4, 0.4, 0.4] }
position = [0, 1, 0]
[[attach]]
body = "lamp"
rigid = "hook"
kind = "rope"
at = [0, 1.2, 0]
radius = 0.15
[[attach]]
body = "lamp"
rigid = "hook"
kind = "rope"
at = [0, 0.8, 0]
radius = 0.15
break_force = 1
length = 2.05
)");
  Simulation3d simulation(scene, {.spes = 2});
  Shown3d shown;
  simulation.show(shown);
  ASSERT_EQ(shown.ropes.size(), 2u);
  for (int frame = 0; frame < 60; ++frame) simulation.step();
  simulation.finish();
  simulation.show(shown);
  ASSERT_EQ(shown.ropes.size(), 1u) << "the second one has broken";
  const ShownRope<3>& rope = shown.ropes[0];
  EXPECT_LT((rope.ends[1] - Vector3f(0, 3, 0)).norm(), 1e-5f);
  EXPECT_NEAR((rope.ends[0] - rope.ends[1]).norm(), rope.length, 0.01f * rope.length);
}

TEST(Attachments2d, AreReadAndHoldAndSayWhatIsWrong) {
  const std::string world =
      "dimension = 2\n[[circle]]\nname = \"hook\"\nradius = 0.2\nposition = [0, 3]\n[[soft_body]]\n"
      "name = \"lamp\"\ncell_size = 0.2\nrows = [\"###\", \"###\"]\nposition = [0, 1]\n[[attach]]\nbody = "
      "\"lamp\"\n"
      "at = [0, 1.2]\nradius = 0.15\n";
  const Scene2d scene =
      std::get<Scene2d>(parse_scene(world + "rigid = \"hook\"\nkind = \"rope\"\n", "s.toml"));
  ASSERT_EQ(scene.attachments.size(), 1u);
  EXPECT_EQ(scene.attachments[0].rigid, std::size_t{0});
  Simulation2d simulation(scene, {.spes = 2});
  for (int frame = 0; frame < 120; ++frame) simulation.step();
  Shown2d shown;
  simulation.show(shown);
  ASSERT_EQ(shown.ropes.size(), 1u);
  const ShownRope<2>& rope = shown.ropes[0];
  EXPECT_LT((rope.ends[1] - Eigen::Vector2f(0, 3)).norm(), 1e-5f);
  EXPECT_NEAR((rope.ends[0] - rope.ends[1]).norm(), rope.length, 0.01f * rope.length);
  const auto says = [&](const std::string& text, const std::string& sentence) {
    const std::string said = refusal(text);
    EXPECT_NE(said.find(sentence), std::string::npos) << "'" << said << "' in place of '" << sentence << "'";
  };
  says(world + "rigid = \"hock\"\n", "there is no rigid body 'hock'; did you mean 'hook'?");
  says(world + "rigid = \"hook\"\nto = \"lamp\"\n", "has to and rigid; give only one of to and rigid");
  says(world + "kind = \"rope\"\n", "it needs the point of its other end");
  says("dimension = 2\n[[box]]\nname = \"a\"\nsize = [1, 1]\n[[circle]]\nname = \"a\"\nradius = 1\n",
       "has the name of another rigid body, 'a'");
}

}  // namespace
}  // namespace softcell::demos
