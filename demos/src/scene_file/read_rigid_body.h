#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "document/value.h"
#include "scene/scene.h"
#include "softcell/base/nearest_name.h"

namespace softcell::demos {

/// Appends the items of `rigid_body` to the scene's. @throws SceneError
void read_rigid_bodies(std::span<const Value> items, Scene& scene);

/// Appends the items of `joint`, which name rigid bodies of the scene: call it after read_rigid_bodies(). @throws SceneError
void read_joints(std::span<const Value> items, Scene& scene);

/// The number of the rigid body of that name. @throws SceneError  there is none.
template <class SceneOf>
std::size_t find_rigid_body(const std::string& name, const Location& location, const SceneOf& scene) {
  std::vector<std::string_view> names;
  for (const auto& body : scene.rigid_bodies) names.push_back(body.name);
  const auto found = std::ranges::find(names, name);
  if (found != names.end() && !name.empty()) return static_cast<std::size_t>(found - names.begin());
  const std::string_view meant = base::nearest_name(name, names);
  throw SceneError(location, fmt::format("there is no rigid body '{}'{}", name,
                                         meant.empty() ? "" : fmt::format("; did you mean '{}'?", meant)));
}

}  // namespace softcell::demos
