#include "read_rigid_body.h"

#include <array>
#include <string>
#include <string_view>

#include "ppu/numbers/deterministic_math.h"
#include "read_common.h"
#include "read_mesh.h"

namespace softcell::demos {
namespace {

constexpr std::size_t kMaxParts = 100, kMaxStops = 1000;
constexpr std::array<std::string_view, 5> kRigidShapes{"box", "sphere", "cylinder", "capsule", "cone"};
constexpr Range kSpin{.low = -100, .high = 100};  // rad/s
constexpr Range kPartLength{.low = 0.001, .high = kFar};

/// Reads a table with `kind` and the lengths of that kind. @param place  whether it may state its pose in the body and its colour
RigidPart read_part(const Value& value, const std::string& what, const RigidPart& usual, bool place) {
  RigidPart part = usual;
  FieldReader fields(value, what);
  std::size_t kind = kRigidShapes.size();
  fields.choice("kind", kind, kRigidShapes, Need::kRequired);
  if (kind == kRigidShapes.size()) throw SceneError(value.location, what + " needs the field 'kind'");
  ppu::RigidShape& shape = part.shape;
  shape.kind = static_cast<ppu::RigidShapeKind>(kind);
  if (shape.kind == ppu::RigidShapeKind::kCapsule) shape.radius = 0.25f;
  if (shape.kind == ppu::RigidShapeKind::kBox)
    fields.vector<3>("size", shape.size, kPartLength);
  else
    fields.number("radius", shape.radius, kPartLength);
  if (shape.kind != ppu::RigidShapeKind::kBox && shape.kind != ppu::RigidShapeKind::kSphere)
    fields.number("height", shape.height, kPartLength);
  if (place) {
    fields.vector<3>("position", shape.position, kCoordinate).colour("colour", part.colour);
    shape.rotation = read_rotation(fields);
  }
  fields.finish();
  if (shape.kind == ppu::RigidShapeKind::kCapsule && !(shape.height > 2 * shape.radius)) {
    throw SceneError(fields.location("height"),
                     fmt::format("height of {} is {}; it must be more than twice its radius, {}", what,
                                 shape.height, shape.radius));
  }
  return part;
}

void read_axis(FieldReader& fields, Eigen::Vector3f& axis) {
  fields.vector<3>("axis", axis, kCoordinate);
  if (axis.norm() < 1e-4f)
    throw SceneError(fields.location("axis"), "axis of " + fields.what() + " must not be 0");
  axis.normalize();
}

Motion read_motion(const Value& value, const std::string& owner) {
  constexpr Range kPeriod{.low = 0.01, .high = kMaxTime}, kDegrees{.low = -36000, .high = 36000};
  Motion motion;
  FieldReader fields(value, "the motion of " + owner);
  read_axis(fields, motion.axis);
  fields.number("spin", motion.spin, kSpin)
      .vector<3>("swing", motion.swing, kCoordinate)
      .number("period", motion.period, kPeriod);
  const auto stops = fields.items("stops", kMaxStops);
  fields.finish();
  for (std::size_t i = 0; i < stops.size(); ++i) {
    FieldReader stop(stops[i], fmt::format("stop {} of {}", i + 1, fields.what()));
    Motion::Stop& added = motion.stops.emplace_back();
    float degrees = 0;
    stop.number("time", added.time, kTime, Need::kRequired)
        .vector<3>("offset", added.offset, kCoordinate)
        .number("degrees", degrees, kDegrees)
        .finish();
    added.angle = static_cast<float>(double{degrees} * ppu::kPi / 180);
    const float before = i > 0 ? motion.stops[i - 1].time : 0;
    if (added.time < before || (i > 0 && added.time == before)) {
      throw SceneError(stop.location("time"),
                       fmt::format("{} is at {} s; the one before is at {} s, and each must be later",
                                   stop.what(), added.time, before));
    }
  }
  return motion;
}

void read_rigid_body(const Value& value, std::size_t index, Scene& scene) {
  FieldReader fields(value, item_name("rigid body", index, stated_name(value)));
  RigidBody body;
  body.name = "rigid body " + std::to_string(index + 1);
  RigidPart usual;
  float friction = 0;
  read_mass(fields, body.mass);
  body.rotation = read_rotation(fields);
  fields.text("name", body.name)
      .vector<3>("position", body.position, kCoordinate)
      .colour("colour", usual.colour)
      .number("opacity", body.opacity, kShare)
      .number("friction", friction, kAnyFriction);
  if (fields.has("friction")) body.friction = friction;
  const Value* const shape = fields.field("shape");
  const auto parts = fields.items("parts", kMaxParts);
  const Value* const motion = fields.field("motion");
  fields.finish();
  if ((shape != nullptr) == !parts.empty())
    throw SceneError(fields.location(), fields.what() + " needs either a shape or parts");
  if (shape != nullptr)
    body.parts.push_back(read_part(*shape, "the shape of " + fields.what(), usual, false));
  for (std::size_t i = 0; i < parts.size(); ++i)
    body.parts.push_back(
        read_part(parts[i], fmt::format("part {} of {}", i + 1, fields.what()), usual, true));
  if (motion != nullptr) {
    if (body.mass > 0) {
      throw SceneError(fields.location("motion"),
                       fields.what() + " has both mass and motion; what the scene moves has no mass");
    }
    body.motion = read_motion(*motion, fields.what());
  }
  for (std::size_t i = 0; i < scene.rigid_bodies.size(); ++i) {
    if (scene.rigid_bodies[i].name == body.name)
      throw SceneError(fields.location("name"),
                       fmt::format("{} and {} have the same name, '{}'; give one of them another",
                                   item_name("rigid body", i), item_name("rigid body", index), body.name));
  }
  scene.rigid_bodies.push_back(std::move(body));
}

std::size_t read_side(FieldReader& fields, std::string_view key, const Scene& scene) {
  std::string name;
  fields.text(key, name, Need::kRequired);
  return fields.has(key) ? find_rigid_body(name, fields.location(key), scene) : 0;
}

}  // namespace

void read_rigid_bodies(std::span<const Value> items, Scene& scene) {
  for (std::size_t i = 0; i < items.size(); ++i) read_rigid_body(items[i], i, scene);
}

void read_joints(std::span<const Value> items, Scene& scene) {
  constexpr Range kTorque{.low = 0, .high = 1e9};
  for (std::size_t i = 0; i < items.size(); ++i) {
    FieldReader fields(items[i], item_name("joint", i));
    Joint joint;
    joint.a = read_side(fields, "a", scene);
    joint.b = read_side(fields, "b", scene);
    read_axis(fields, joint.axis);
    fields.vector<3>("point", joint.point, kCoordinate, Need::kRequired)
        .number("speed", joint.speed, kSpin)
        .number("torque", joint.torque, kTorque)
        .finish();
    if (joint.a == joint.b)
      throw SceneError(fields.location("b"), fields.what() + " joins a rigid body to itself");
    if (scene.rigid_bodies[joint.a].mass == 0 && scene.rigid_bodies[joint.b].mass == 0)
      throw SceneError(fields.location(), fields.what() + " joins two bodies without a mass; one needs one");
    scene.joints.push_back(joint);
  }
}

}  // namespace softcell::demos
