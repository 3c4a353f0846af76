#pragma once
// Writes scene files of the present state of a run. docs/reference/scenes.md describes them.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/scene_2d.h"
#include "scene_document.h"

namespace softcell::demos {

/// The state of a run, in so far as it differs from its scene.
template <int Dimension>
struct PresentScene {
  Beginning<Dimension> moment;                   ///< Simulation::moment()
  std::vector<ppu::SoftBodySettings> materials;  ///< of each soft body
  int substeps = 1;                              ///< per 1/60 s
};

/// The scene's document with the present gravity, substeps and materials. @throws std::runtime_error  the scene has no document
Table present_root(const Scene& scene, const PresentScene<3>& now);
Table present_root(const Scene2d& scene, const PresentScene<2>& now);

struct SceneFile {
  std::filesystem::path path;
  std::string bytes;
};

/// The files of a scene that begins with the present state: the scene itself, the state file beside it, and the built-in files that it
/// needs. Their names begin with that of the scene. The scene file contains the scene's document in TOML with all its fields, and the
/// present values of those that differ: gravity, substeps, materials, the camera, and the model or picture of the command line.
/// @param scene_file  where it will be written; its name ends in .toml  @param camera  from which it is to be seen
/// @param contacts  that the run has used
/// @throws std::runtime_error  one sentence: the scene uses a file that a scene at that place cannot name, or a value is beyond what a
/// scene file may state
std::vector<SceneFile> saved_scene(const Scene& scene, const PresentScene<3>& now,
                                   const render::Camera& camera, ppu::ContactMethod contacts,
                                   const std::filesystem::path& scene_file);
std::vector<SceneFile> saved_scene(const Scene2d& scene, const PresentScene<2>& now,
                                   ppu::ContactMethod contacts, const std::filesystem::path& scene_file);

/// Writes all of them, or none. @throws std::runtime_error  one cannot be written; the message names it
void write_scene_files(std::span<const SceneFile> files);

/// A name for the scene file that no file has yet: NAME_1.toml, NAME_2.toml, ... beside the scene's own file, beside the model or picture
/// of the command line, or in the present folder. @param document  null: none
std::filesystem::path free_scene_file(const SceneDocument* document, const std::string& scene_name);

}  // namespace softcell::demos
