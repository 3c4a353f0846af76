#include "scene_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "document/documents.h"
#include "document/field_reader.h"
#include "read_scene.h"
#include "scene_document.h"
#include "scene_source.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

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
  if (model)
    document->own = OwnFile{.file = model->file,
                            .z_up = model->z_up,
                            .longest_side = model->longest_side,
                            .tessellation = model->tessellation};
  scene.document = std::move(document);
  return scene;
}

/// Whether a script returns a lattice for a scene to use: see read_lattice_2d.h.
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

namespace {

/// None: the file is no scene of that dimension.
std::optional<std::string> title_of(const std::filesystem::path& file, int dimension) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 20;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error) || std::filesystem::file_size(file, error) > kMostBytes)
    return std::nullopt;
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  try {
    const Value document = parse_toml(text.view(), std::make_shared<const std::string>(file.string()));
    FieldReader root(document, "a scene");
    constexpr std::array kParts{"soft_body", "rigid_body", "framework", "box", "obstacle"};
    if (std::ranges::none_of(kParts, [&](const char* part) { return root.has(part); })) return std::nullopt;
    if (read_dimension(root) != dimension) return std::nullopt;
    std::string title;
    root.text("title", title);
    return base::one_line(title);
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<SceneFileListing> scene_files(const std::filesystem::path& folder, int dimension) {
  SC_ASSERT(dimension == 2 || dimension == 3, "scenes of {} dimensions", dimension);
  constexpr std::size_t kMost = 200;
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() == ".toml") files.push_back(entry->path());
  std::ranges::sort(files);
  if (files.size() > kMost) files.resize(kMost);
  std::vector<SceneFileListing> found;
  for (const std::filesystem::path& file : files)
    if (auto title = title_of(file, dimension)) found.push_back({file, *std::move(title)});
  return found;
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
