#pragma once
// Limits and readers that scenes in two and in three dimensions share.

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>

#include "document/field_reader.h"
#include "scene/frame_time.h"
#include "scene/scene.h"
#include "scene/scripted_input.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

// No host can play more than these; a larger number is more likely a typing error.
inline constexpr std::size_t kMaxSoftBodies = 256, kMaxRigidBodies = 1000, kMaxEvents = 1000,
                             kMaxPictures = 1000, kMaxAttachments = 1000;
inline constexpr std::uint32_t kMaxParticlesOfScene = 300'000;
/// Call it while the bodies of a scene are read. @throws SceneError  there are too many particles so far
inline void check_particles(std::size_t particles, const Location& location) {
  if (particles > kMaxParticlesOfScene)
    throw SceneError(location, fmt::format("the scene has {} particles or more; it may have at most {}",
                                           particles, kMaxParticlesOfScene));
}
/// Call it when a body is added to a scene. @throws SceneError  there would be too many particles
inline void check_added_particles(std::size_t particles, const Location& location) {
  if (particles > kMaxParticlesOfScene)
    throw SceneError(location, fmt::format("the scene would have {} particles; it may have at most {}",
                                           particles, kMaxParticlesOfScene));
}
inline constexpr std::size_t kMaxVerticesOfScene = 2'000'000;
inline constexpr int kMaxFrames = 1'000'000;
inline constexpr double kMaxGravity = 1000;  // m/s^2
inline constexpr double kMaxMass = 1e6;      // kg
inline constexpr double kLeastMass = 1e-6;   // kg, if it moves: floats hold inverses of masses and inertias
inline constexpr double kLeastCellSize = 0.001;  // metres, for the same reason
inline constexpr double kMaxTime = 1e5;          // seconds
inline constexpr double kMaxSpeed = 1000;        // m/s
inline constexpr Range kGravityOfScene{.low = -kMaxGravity, .high = kMaxGravity};
inline constexpr Range kMass{.low = 0, .high = kMaxMass};
inline constexpr Range kTime{.low = 0, .high = kMaxTime};
inline constexpr Range kVelocity{.low = -kMaxSpeed, .high = kMaxSpeed};
inline constexpr Range kAnyFriction{.low = 0, .high = 100};

/// "soft body 2 ('torus')".
inline std::string item_name(const char* kind, std::size_t index, const std::string& name = {}) {
  return fmt::format("{} {}{}", kind, index + 1, name.empty() ? "" : fmt::format(" ('{}')", name));
}

/// The text in an item's `name`, for messages about the item.
inline std::string stated_name(const Value& item) {
  const auto* table = std::get_if<Table>(&item.data);
  if (table == nullptr) return {};
  for (const auto& [key, value] : *table) {
    const auto* text = std::get_if<std::string>(&value.data);
    if (key == "name" && text != nullptr) return *text;
  }
  return {};
}

/// Reads the fields `title`, `frames` and `pictures` of the scene, and its table `world`.
/// @param SceneOf  Scene or Scene2d
template <class SceneOf>
void read_world(FieldReader& fields, SceneOf& scene) {
  fields.text("title", scene.title);
  const std::span<const Value> pictures = fields.items("pictures", kMaxPictures);
  if (const Value* world = fields.field("world")) {
    FieldReader reader(*world, "world");
    reader.number("gravity", scene.gravity, kGravityOfScene)
        .number("friction", scene.friction, kAnyFriction)
        .number("restitution", scene.restitution, kShare)
        .integer("substeps", scene.substeps, 1, kMaxSubsteps)
        .integer("frames", scene.frames, 1, kMaxFrames);
    if constexpr (requires { scene.contacts; }) {
      auto contacts = static_cast<std::size_t>(scene.contacts);
      reader.choice("contacts", contacts, kContactMethods);
      scene.contacts = static_cast<ppu::ContactMethod>(contacts);
    }
    if constexpr (requires { scene.sleep; }) reader.flag("sleep", scene.sleep);
    reader.finish();
  }
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    scene.pictures.push_back(
        read_integer(pictures[i], fmt::format("number {} of pictures", i + 1), 1, scene.frames));
  }
  std::sort(scene.pictures.begin(), scene.pictures.end());
}

/// Reads the field `mass` of a rigid body. @throws SceneError
inline void read_mass(FieldReader& fields, float& mass) {
  fields.number("mass", mass, kMass);
  if (mass > 0 && mass < static_cast<float>(kLeastMass)) {
    throw SceneError(
        fields.location("mass"),
        fmt::format("mass of {} is {}; it must be 0, which does not move, or a number from {} to {}",
                    fields.what(), mass, kLeastMass, kMaxMass));
  }
}

/// Seconds per substep.
template <class SceneOf>
double step_of(const SceneOf& scene) {
  SC_ASSERT(scene.substeps > 0, "{} substeps in a frame", scene.substeps);
  return 1.0 / 60 / scene.substeps;
}

/// Events refer to soft bodies by name, so each must have a name of its own, default names included.
/// @param fields  of the scene's last soft body. @throws SceneError  another body has its name.
template <class SceneOf>
void check_name(const FieldReader& fields, const SceneOf& scene) {
  SC_ASSERT(!scene.soft_bodies.empty(), "the last body of {} is none", fields.what());
  const auto& bodies = scene.soft_bodies;
  const auto first = std::find_if(bodies.begin(), bodies.end(),
                                  [&](const auto& body) { return body.name == bodies.back().name; });
  const auto index = static_cast<std::size_t>(first - bodies.begin());
  if (index + 1 == bodies.size()) return;
  throw SceneError(fields.location("name"),
                   fmt::format("{} and {} have the same name, '{}'; give one of them another",
                               item_name("soft body", index), item_name("soft body", bodies.size() - 1),
                               bodies.back().name));
}

/// The number of the soft body of that name. @throws SceneError  there is none.
template <class SceneOf>
std::size_t find_body(const std::string& name, const Location& location, const SceneOf& scene) {
  const auto found = std::find_if(scene.soft_bodies.begin(), scene.soft_bodies.end(),
                                  [&](const auto& body) { return body.name == name; });
  if (found == scene.soft_bodies.end())
    throw SceneError(location, fmt::format("there is no soft body '{}'", name));
  return static_cast<std::size_t>(found - scene.soft_bodies.begin());
}

/// The number of the soft body that an event names. @throws SceneError  none has that name.
template <class SceneOf>
std::size_t read_body(FieldReader& event, const SceneOf& scene) {
  std::string name;
  event.text("body", name, Need::kRequired);
  return event.has("body") ? find_body(name, event.location("body"), scene) : scene.soft_bodies.size();
}

/// Reads the fields `begin` and `end` of an event that lasts. @throws SceneError  it ends before it begins.
template <class Event>
void read_duration(FieldReader& fields, Event& event) {
  fields.number("begin", event.begin, kTime, Need::kRequired)
      .number("end", event.end, kTime, Need::kRequired)
      .finish();
  if (event.end <= event.begin) {
    throw SceneError(fields.location("end"),
                     fmt::format("{} ends at {} s; it begins at {} s and must end later", fields.what(),
                                 event.end, event.begin));
  }
}

/// Reads the tables `impulse`, `drag`, `gravity`, `pause` and `reset` of the scene. Its soft bodies must have been read.
template <int Dimension, class SceneOf>
void read_script(FieldReader& fields, SceneOf& scene) {
  const auto impulses = fields.items("impulse", kMaxEvents);
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    FieldReader event(impulses[i], item_name("impulse", i));
    auto& impulse = scene.script.impulses.emplace_back();
    impulse.body = read_body(event, scene);
    event.number("time", impulse.time, kTime, Need::kRequired)
        .template vector<Dimension>("velocity", impulse.velocity, kVelocity, Need::kRequired)
        .finish();
  }
  const auto drags = fields.items("drag", kMaxEvents);
  for (std::size_t i = 0; i < drags.size(); ++i) {
    FieldReader event(drags[i], item_name("drag", i));
    auto& drag = scene.script.drags.emplace_back();
    drag.body = read_body(event, scene);
    event.template vector<Dimension>("from", drag.from, kCoordinate, Need::kRequired)
        .template vector<Dimension>("to", drag.to, kCoordinate, Need::kRequired);
    read_duration(event, drag);
  }
  const auto changes = fields.items("gravity", kMaxEvents);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    GravityChange& change = scene.script.gravity.emplace_back();
    FieldReader(changes[i], item_name("gravity", i))
        .number("time", change.time, kTime, Need::kRequired)
        .number("value", change.gravity, kGravityOfScene, Need::kRequired)
        .finish();
  }
  const auto pauses = fields.items("pause", kMaxEvents);
  for (std::size_t i = 0; i < pauses.size(); ++i) {
    FieldReader event(pauses[i], item_name("pause", i));
    read_duration(event, scene.script.pauses.emplace_back());
  }
  const auto resets = fields.items("reset", kMaxEvents);
  for (std::size_t i = 0; i < resets.size(); ++i) {
    FieldReader(resets[i], item_name("reset", i))
        .number("time", scene.script.resets.emplace_back(), kTime, Need::kRequired)
        .finish();
  }
}

}  // namespace softcell::demos
