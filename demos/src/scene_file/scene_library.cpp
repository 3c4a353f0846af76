#include "scene_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "documents.h"
#include "field_reader.h"
#include "read_scene.h"
#include "scene_document.h"
#include "scene_source.h"

namespace softcell::demos {
namespace {

int read_dimension(FieldReader& root) {
  int dimension = 3;
  root.integer("dimension", dimension, 2, 3);
  return dimension;
}

Value read_document(const SourceText& text) {
  return text.is_lua() ? run_lua(text.text, text.name) : parse_toml(text.text, text.name);
}

std::variant<Scene, Scene2d> read_scene(const SceneSource& source,
                                        const std::optional<OwnModel>& model = std::nullopt,
                                        const std::optional<OwnPicture>& picture = std::nullopt) {
  auto document = std::make_shared<SceneDocument>();
  document->root = read_document(source.main());
  document->folder = source.folder();
  FieldReader root(document->root, "a scene");
  if (read_dimension(root) == 2) {
    Scene2d scene = read_scene_2d(root, source, picture);
    scene.files = source.files();
    if (picture) document->own = OwnFile{.file = picture->file};
    scene.document = std::move(document);
    return scene;
  }
  Scene scene = read_scene_3d(root, source, model);
  scene.files = source.files();
  if (model) document->own = OwnFile{.file = model->file, .z_up = model->z_up};
  scene.document = std::move(document);
  return scene;
}

/// What a script returns for a scene to use: see read_lattice_2d.h.
bool is_lattice(const Value& document) {
  const Table* const table = std::get_if<Table>(&document.data);
  return table != nullptr && std::ranges::any_of(*table, [](const Field& field) {
           return field.name == "cells" || field.name == "rows";
         });
}

}  // namespace

const std::vector<SceneListing>& list_scenes() {
  static const std::vector<SceneListing> scenes = [] {
    std::vector<SceneListing> found;
    for (const base::EmbeddedFile& file : embedded_scenes()) {
      if (!is_scene_file(file.name)) continue;  // a model
      const Value document =
          read_document({std::string(file.text), std::make_shared<const std::string>(file.name)});
      if (is_lattice(document)) continue;
      SceneListing& scene = found.emplace_back();
      scene.name = file.name.substr(0, file.name.rfind('.'));
      FieldReader root(document, "a scene");
      scene.dimension = read_dimension(root);
      root.text("title", scene.title, Need::kRequired);
    }
    return found;
  }();
  return scenes;
}

bool is_scene_file(std::string_view name_or_file) {
  const std::filesystem::path ending = std::filesystem::path(name_or_file).extension();
  return ending == ".toml" || ending == ".lua";
}

std::variant<Scene, Scene2d> load_scene(std::string_view name_or_file) {
  return read_scene(SceneSource::find(name_or_file));
}

std::variant<Scene, Scene2d> parse_scene(const std::string& text, const std::string& name) {
  return read_scene(SceneSource::in_memory(text, name));
}

Scene load_scene_3d(std::string_view name_or_file, const std::optional<OwnModel>& model) {
  auto scene = read_scene(SceneSource::find(name_or_file), model);
  if (auto* found = std::get_if<Scene>(&scene)) return std::move(*found);
  throw std::runtime_error(
      fmt::format("scene {} has two dimensions; it is for softcell demo 2d", name_or_file));
}

Scene2d load_scene_2d(std::string_view name_or_file, const std::optional<OwnPicture>& picture) {
  auto scene = read_scene(SceneSource::find(name_or_file), std::nullopt, picture);
  if (auto* found = std::get_if<Scene2d>(&scene)) return std::move(*found);
  throw std::runtime_error(
      fmt::format("scene {} has three dimensions; it is for softcell demo 3d", name_or_file));
}

}  // namespace softcell::demos
