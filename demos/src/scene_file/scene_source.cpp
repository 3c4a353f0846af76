#include "scene_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "scene_library.h"
#include "softcell/base/assert.h"
#include "softcell/base/nearest_name.h"
#include "softcell/base/read_file.h"
#include "state_file.h"

namespace softcell::demos {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSystemData = "/usr/share";

SourceText embedded_text(const base::EmbeddedFile& file) {
  return {std::string(file.text), std::make_shared<const std::string>(file.name)};
}

SourceText read_text(const fs::path& path) {
  const auto bytes = base::read_file(path, SceneSource::kMaxTextBytes);
  return {std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
          std::make_shared<const std::string>(path.string())};
}

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [rest, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return rest == folder.end();
}

/// False for a name with control characters, which would garble a message that quotes it.
bool is_printable(const std::string& name) {
  return std::none_of(name.begin(), name.end(),
                      [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; });
}

/// @param name  neither of a built-in scene nor of a scene file
[[noreturn]] void refuse(const fs::path& name) {
  if (name.has_extension() || name.has_parent_path())
    throw std::runtime_error(
        fmt::format("'{}' is no scene: a scene file ends in .toml or .lua", name.string()));
  std::vector<std::string_view> known;
  for (const SceneListing& scene : list_scenes()) known.push_back(scene.name);
  if (const std::string_view meant = base::nearest_name(name.native(), known); !meant.empty())
    throw std::runtime_error(fmt::format("unknown scene '{}'; did you mean '{}'?", name.string(), meant));
  throw std::runtime_error(
      fmt::format("unknown scene '{}'; there are: {}; or give a scene file, which ends in .toml or .lua",
                  name.string(), fmt::join(known, ", ")));
}

}  // namespace

SceneSource SceneSource::find(std::string_view name_or_file) {
  SceneSource source;
  // By its file, not by list_scenes(), which would read every scene and run those in Lua.
  for (const std::string_view ending : {".toml", ".lua"}) {
    const std::string file = fmt::format("{}{}", name_or_file, ending);
    if (const base::EmbeddedFile* embedded = base::find_embedded(embedded_scenes(), file)) {
      source.main_ = embedded_text(*embedded);
      return source;
    }
  }
  const fs::path path{name_or_file};
  if (!is_scene_file(name_or_file)) refuse(path);
  source.main_ = read_text(path);
  source.folder_ = fs::weakly_canonical(path).parent_path();
  source.files_.push_back(path);
  return source;
}

SceneSource SceneSource::in_memory(std::string text, const std::string& name) {
  SceneSource source;
  source.main_ = {std::move(text), std::make_shared<const std::string>(name)};
  return source;
}

SceneSource SceneSource::of_user(std::vector<fs::path> files) {
  SceneSource source = in_memory({}, "file");
  source.of_user_ = std::move(files);
  return source;
}

std::string SceneSource::name() const { return fs::path(*main_.name).stem().string(); }

fs::path SceneSource::locate(const std::string& file, const Location& location) const {
  SC_ASSERT(main_.name != nullptr, "a scene without a name names the file '{}'", file);
  const fs::path named(file);
  if (file.empty() || !is_printable(file))
    throw SceneError(location, "a file needs a name of printable characters");
  if (!folder_ && !named.is_absolute())
    throw SceneError(location, fmt::format("there is no built-in file '{}'", file));
  std::error_code error;
  const fs::path found = fs::weakly_canonical(named.is_absolute() ? named : *folder_ / named, error);
  const bool of_user = std::ranges::find(of_user_, named) != of_user_.end();
  const bool allowed = !error && (of_user || is_below(found, kSystemData) ||
                                  (folder_ && !named.is_absolute() && is_below(found, *folder_)));
  if (!allowed) {
    throw SceneError(location,
                     fmt::format("'{}' is outside; a scene may name files below its own folder, and below {}",
                                 file, kSystemData));
  }
  files_.push_back(found);
  return found;
}

SourceText SceneSource::text(const std::string& file, const Location& location) const {
  if (!folder_) {
    if (const base::EmbeddedFile* embedded = base::find_embedded(embedded_scenes(), file))
      return embedded_text(*embedded);
  }
  const fs::path path = locate(file, location);
  try {
    return read_text(path);
  } catch (const std::runtime_error& error) {
    throw SceneError(location, error.what());
  }
}

fs::path SceneSource::mesh(const std::string& file, const Location& location) const {
  fs::path path = locate(file, location);
  std::error_code error;
  if (fs::is_directory(path, error))
    throw SceneError(location, fmt::format("'{}' is a folder; expected is a mesh file", file));
  if (!fs::is_regular_file(path, error)) {
    const bool bunny = !folder_ && file.ends_with("bunny.obj");
    throw SceneError(location, fmt::format("there is no mesh file '{}'{}", file,
                                           bunny ? ": install the package glmark2-data" : ""));
  }
  return path;
}

const base::EmbeddedFile* SceneSource::embedded_mesh(const std::string& file) const {
  return folder_ ? nullptr : base::find_embedded(embedded_scenes(), file);
}

void SceneSource::add_files(std::span<const fs::path> files) const {
  files_.insert(files_.end(), files.begin(), files.end());
}

fs::path SceneSource::picture(const std::string& file, const Location& location) const {
  fs::path path = locate(file, location);
  std::error_code error;
  if (fs::is_directory(path, error))
    throw SceneError(location, fmt::format("'{}' is a folder; expected is a picture file", file));
  if (!fs::is_regular_file(path, error))
    throw SceneError(location, fmt::format("there is no picture file '{}'", file));
  return path;
}

std::string SceneSource::state(const std::string& file, const Location& location) const {
  const fs::path path = locate(file, location);
  try {
    const auto bytes = base::read_file(path, kMaxStateBytes);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  } catch (const std::runtime_error& error) {
    throw SceneError(location, error.what());
  }
}

}  // namespace softcell::demos
