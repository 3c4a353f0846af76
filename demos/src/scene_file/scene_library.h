#pragma once
// Finds and loads scenes by name or file. docs/reference/scenes.md describes the files.
//
// A scene or lattice in Lua runs in a child process made by fork(): load scenes before threads are started.

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
  std::string name;   ///< the name by which it is found: "arena"
  int dimension = 3;  ///< 2 or 3
  std::string title;  ///< one line
};

/// The scenes that are part of the command, sorted by name. The first call reads all of them.
const std::vector<SceneListing>& list_scenes();

/// A scene file that is not part of the command.
struct SceneFileListing {
  std::filesystem::path file;
  std::string title;  ///< one line; may be empty
};

/// The TOML scenes of one dimension in a folder, sorted by name; at most 200. Leaves out files that are not TOML, that are larger than a
/// megabyte, or that contain nothing of a scene; it checks nothing else. The result is empty for a folder that cannot be read.
std::vector<SceneFileListing> scene_files(const std::filesystem::path& folder, int dimension);

/// The user's own model. It replaces the body of the scene that has the field `own_model_side`.
struct OwnModel {
  ppu::TriangleMesh mesh;
  float cell_size = 0;                            ///< in the mesh's units
  std::vector<std::string> notes = {};            ///< as for Scene::notes
  std::vector<std::filesystem::path> files = {};  ///< files that it was read from
  std::filesystem::path file = {};                ///< the first of `files`, as scenes name it
  bool z_up = false;                              ///< it was turned, because its z axis points upwards
  std::optional<float> longest_side = {};         ///< metres; none: that of the body that it replaces
  std::optional<float> tessellation = {};         ///< in cells, as for the field `tessellate`
};

/// The user's own picture. It replaces the body of the 2D scene that has the field `own_image_side`.
struct OwnPicture {
  std::shared_ptr<const render::Image> image;
  int cells = kCellsAlongPicture;   ///< along the longest side of its silhouette
  std::filesystem::path file = {};  ///< the file that it was read from
};

/// The user gives a model or a picture, and no body of the scene can be replaced by it.
class NoPlaceForModel : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether load_scene() takes this for a file and not for the name of a built-in scene.
bool is_scene_file(std::string_view name_or_file);

/// @param name_or_file  a built-in scene's name, or a file that ends in .toml or .lua.
/// @throws std::runtime_error  there is no such scene, or it has a mistake (SceneError): one sentence.
std::variant<Scene, Scene2d> load_scene(std::string_view name_or_file);

/// A scene in memory: see SceneSource::in_memory(). @throws SceneError
std::variant<Scene, Scene2d> parse_scene(const std::string& text, const std::string& name);

/// Like load_scene(), for one dimension; refuses a scene of the other dimension.
/// @throws NoPlaceForModel  there is no body that the model or picture can replace
Scene load_scene_3d(std::string_view name_or_file, const std::optional<OwnModel>& model = std::nullopt);
Scene2d load_scene_2d(std::string_view name_or_file, const std::optional<OwnPicture>& picture = std::nullopt);

}  // namespace softcell::demos
