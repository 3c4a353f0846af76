#pragma once
// Scenes by name or file. docs/reference/scenes.md describes the files.
//
// A scene or lattice in Lua runs in a child process, made by fork(): load scenes before threads are started.

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "picture_cells.h"
#include "scene/scene.h"
#include "scene/scene_2d.h"

namespace softcell::demos {

struct SceneListing {
  std::string name;   ///< by which it is found: "arena"
  int dimension = 3;  ///< 2 or 3
  std::string title;  ///< one line
};

/// The scenes that are part of the command, sorted by name. Reads all of them, once.
const std::vector<SceneListing>& list_scenes();

/// A scene file that is not part of the command.
struct SceneFileListing {
  std::filesystem::path file;
  std::string title;  ///< one line; may be empty
};

/// The scenes of one dimension in TOML in a folder, sorted by name; at most 200. Files that are not TOML, larger than a megabyte or
/// without anything of a scene are left out: nothing else is checked. A folder that cannot be read has none.
std::vector<SceneFileListing> scene_files(const std::filesystem::path& folder, int dimension);

/// The user's own model. It replaces the body of the scene that has the field `own_model_side`.
struct OwnModel {
  ppu::TriangleMesh mesh;
  float cell_size = 0;                            ///< in the mesh's units
  std::vector<std::string> notes = {};            ///< as Scene::notes
  std::vector<std::filesystem::path> files = {};  ///< that it was read from
  std::filesystem::path file = {};                ///< the first of them, as scenes name it
  bool z_up = false;                              ///< turned from there
  std::optional<float> longest_side = {};         ///< metres; none: of what it replaces
  std::optional<float> tessellation = {};         ///< cells, as the field `tessellate`
};

/// The user's own picture. It replaces the body of the 2D scene that has the field `own_image_side`.
struct OwnPicture {
  std::shared_ptr<const render::Image> image;
  int cells = kCellsAlongPicture;   ///< along the longest side of its silhouette
  std::filesystem::path file = {};  ///< that it was read from
};

/// The user gives a model or a picture, and no body of the scene can be replaced by it.
class NoPlaceForModel : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether load_scene() reads this as a file and not as the name of a built-in scene.
bool is_scene_file(std::string_view name_or_file);

/// @param name_or_file  a built-in scene's name, or a file that ends in .toml or .lua.
/// @throws std::runtime_error  there is no such scene, or it is wrong (SceneError): one sentence.
std::variant<Scene, Scene2d> load_scene(std::string_view name_or_file);

/// A scene in memory: see SceneSource::in_memory(). @throws SceneError
std::variant<Scene, Scene2d> parse_scene(const std::string& text, const std::string& name);

/// As load_scene(), for one dimension; a scene of the other is refused.
/// @throws NoPlaceForModel  also.
Scene load_scene_3d(std::string_view name_or_file, const std::optional<OwnModel>& model = std::nullopt);
Scene2d load_scene_2d(std::string_view name_or_file, const std::optional<OwnPicture>& picture = std::nullopt);

}  // namespace softcell::demos
