#pragma once
// Scene files of what a run has become. docs/reference/scenes.md describes them.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/scene_2d.h"
#include "scene_document.h"

namespace softcell::demos {

/// What a run has changed of its scene.
template <int Dimension>
struct PresentScene {
  Beginning<Dimension> moment;                   ///< Simulation::moment()
  std::vector<ppu::SoftBodySettings> materials;  ///< of each soft body
  int substeps = 1;                              ///< of a frame of 1/60 s
};

/// The scene's document with the gravity, substeps and materials of now. @throws std::runtime_error  it has none
Table present_root(const Scene& scene, const PresentScene<3>& now);
Table present_root(const Scene2d& scene, const PresentScene<2>& now);

struct SceneFile {
  std::filesystem::path path;
  std::string bytes;
};

/// The files of a scene that begins with what there is: the scene itself, the state beside it, and what it needs of built-in
/// files. Their names begin with that of the scene. They hold the scene's document with all its fields, in TOML, and what is other than
/// there: gravity, substeps, materials, the camera, and the model or picture of the command line.
/// @param scene_file  where it will be written; its name ends in .toml  @param camera  from where it is to be seen
/// @param contacts  with which the run was made
/// @throws std::runtime_error  one sentence: the scene uses a file that a scene there cannot name, or has moved beyond what a
///                             scene can say
std::vector<SceneFile> saved_scene(const Scene& scene, const PresentScene<3>& now,
                                   const render::Camera& camera, ppu::ContactMethod contacts,
                                   const std::filesystem::path& scene_file);
std::vector<SceneFile> saved_scene(const Scene2d& scene, const PresentScene<2>& now,
                                   ppu::ContactMethod contacts, const std::filesystem::path& scene_file);

/// All of them appear, or none. @throws std::runtime_error  one cannot be written; the sentence names it
void write_scene_files(std::span<const SceneFile> files);

/// A name for it that no file has: NAME_1.toml, NAME_2.toml, ... beside the scene's own file, beside the model or picture
/// of the command line, or in the present folder. @param document  null: none
std::filesystem::path free_scene_file(const SceneDocument* document, const std::string& scene_name);

}  // namespace softcell::demos
