#pragma once
// Applies a change that a user makes to a scene in a window, in either dimension.

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "demo/demo.h"
#include "input/input_event.h"
#include "scene_file/change_scene.h"
#include "scene_file/scene_library.h"

namespace softcell::tool {

/// @param new_body  () -> size, stiffness and place of a body that is added
/// @throws std::runtime_error  one sentence
template <int Dimension, class SceneOf, class Place>
SceneOf changed_scene(const SceneOf& scene, const demos::PresentScene<Dimension>& now,
                      const demos::SceneChange& change, const Place& new_body) {
  using Kind = demos::SceneChange::Kind;
  SceneOf changed = demos::scene_now(scene, now);
  switch (change.kind) {
    case Kind::kFile:
      demos::add_file(changed, change.file, new_body());
      break;
    case Kind::kShape:
      demos::add_shape(changed, change.name, new_body());
      break;
    case Kind::kRemove:
      if (change.body >= changed.soft_bodies.size()) throw std::runtime_error("there is no such soft body");
      demos::remove_body(changed, change.body);
      break;
    case Kind::kDensity:
      for (std::size_t b = 0; b < changed.soft_bodies.size(); ++b)
        if (change.body == demos::kEveryBody || change.body == b)
          demos::set_density(changed, b, change.number);
      break;
  }
  return changed;
}

/// The user's scene files in the present folder.
inline std::vector<demos::OwnScene> scene_files_here(int dimension) {
  std::vector<demos::OwnScene> own;
  for (const demos::SceneFileListing& listing : demos::scene_files(".", dimension))
    own.push_back({listing.file.lexically_normal(), listing.title});
  return own;
}

/// Refuses a scene in Lua: its script would run in a child process, which a program with threads cannot make.
/// @throws std::runtime_error  the file is in Lua
inline void refuse_lua(const std::filesystem::path& scene_file) {
  if (scene_file.extension() == ".lua")
    throw std::runtime_error(
        scene_file.string() +
        ": a scene in Lua cannot be opened while another one runs; give it with --scene");
}

}  // namespace softcell::tool
