#pragma once
// Reads the table `begin` of a scene: the moment of a run with which the scene begins.

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "document/field_reader.h"
#include "read_common.h"
#include "scene/beginning.h"
#include "scene_source.h"
#include "state_file.h"

namespace softcell::demos {

/// Null if there is no such table. @param particles  their number in each soft body, in order
/// @throws SceneError  also if the state belongs to other bodies
template <int Dimension, class SceneOf>
std::shared_ptr<const Beginning<Dimension>> read_begin(const Value* value, const SceneSource& source,
                                                       const std::vector<std::size_t>& particles,
                                                       const SceneOf& scene) {
  if (value == nullptr) return nullptr;
  constexpr Range kTilt{.low = -1.6, .high = 1.6}, kTimeScale{.low = 0.02, .high = 4},
      kSeconds{.low = 0, .high = 1e7};
  FieldReader fields(*value, "begin");
  std::string file;
  using Vector = Eigen::Matrix<float, Dimension, 1>;
  Vector gravity = Vector::Zero(), tilt = Vector::Zero();
  float time_scale = 1, seconds = 0;
  int frames = 0;
  fields.text("state", file, Need::kRequired)
      .template vector<Dimension>("gravity", gravity, kGravityOfScene)
      .number("time_scale", time_scale, kTimeScale)
      .integer("frames", frames, 0, std::numeric_limits<int>::max());
  if constexpr (Dimension == 3) fields.vector<3>("tilt", tilt, kTilt).number("seconds", seconds, kSeconds);
  fields.finish();
  auto begin = std::make_shared<Beginning<Dimension>>();
  const Location& location = fields.location("state");
  const std::string text = source.state(file, location);
  try {
    *begin = parse_state<Dimension>(text);
  } catch (const std::runtime_error& error) {
    throw SceneError(location, fmt::format("{}: {}", file, error.what()));
  }
  if (begin->soft_bodies.size() != scene.soft_bodies.size())
    throw SceneError(location, fmt::format("{} has {} soft bodies, and the scene has {}", file,
                                           begin->soft_bodies.size(), scene.soft_bodies.size()));
  for (std::size_t b = 0; b < particles.size(); ++b) {
    if (begin->soft_bodies[b].positions.size() != particles[b])
      throw SceneError(location, fmt::format("{} has {} particles of soft body '{}', which has {}", file,
                                             begin->soft_bodies[b].positions.size(),
                                             scene.soft_bodies[b].name, particles[b]));
  }
  if (fields.has("gravity")) begin->gravity = gravity;
  if (fields.has("tilt")) begin->tilt = tilt;
  begin->time_scale = time_scale;
  begin->frames = frames;
  begin->seconds = double{seconds};
  return begin;
}

}  // namespace softcell::demos
