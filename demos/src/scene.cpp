#include "scene.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "scenes/scenes.h"

namespace softcell::demos {

std::span<const SceneEntry> scenes() {
  static const std::array<SceneEntry, 2> all{{
      {"arena", "the 3D demo: a walled floor that tilts, obstacles, five soft bodies, rigid boxes",
       [](const std::optional<OwnModel>&) { return make_arena(); }},
      {"drop", "one soft body falls onto a floor; with --mesh, your own", make_drop},
  }};
  return all;
}

const SceneEntry& find_scene(std::string_view name) {
  const auto all = scenes();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SceneEntry& entry) { return entry.name == name; });
  if (found != all.end()) return *found;
  std::string known;
  for (const SceneEntry& entry : all) known += (known.empty() ? "" : ", ") + std::string(entry.name);
  throw std::runtime_error("unknown scene '" + std::string(name) + "'; there are: " + known);
}

}  // namespace softcell::demos
