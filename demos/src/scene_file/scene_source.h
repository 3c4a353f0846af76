#pragma once
// Finds a scene and the files that it names, either built into the command or in a folder.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "document/value.h"
#include "softcell/base/embedded_file.h"

namespace softcell::demos {

/// The files of demos/scenes, sorted by name.
std::span<const base::EmbeddedFile> embedded_scenes();

/// The text of a scene or of a lattice, and its name in error messages.
struct SourceText {
  std::string text;
  std::shared_ptr<const std::string> name;

  bool is_lua() const { return name->ends_with(".lua"); }
};

/// A scene that is built into the command, or a scene file of the user. A scene file may name files below its own folder (after links are
/// followed) and meshes below /usr/share, so that a scene from somebody else cannot read the user's other files.
class SceneSource {
 public:
  static constexpr std::uintmax_t kMaxTextBytes = 4 << 20;

  /// @param name_or_file  the name of a built-in scene; or, with '/' or an ending, a file.
  /// @throws std::runtime_error  there is no such scene or file; the message lists the scenes.
  static SceneSource find(std::string_view name_or_file);

  /// A scene in memory. It may name built-in files and files that the system has installed.
  /// @param name  the scene's name; error messages say "NAME.toml" or "NAME.lua".
  static SceneSource in_memory(std::string text, const std::string& name);

  /// No scene, only files that the user has chosen: these may be named, by their absolute paths, and no others.
  static SceneSource of_user(std::vector<std::filesystem::path> files);

  const SourceText& main() const { return main_; }
  std::string name() const;  ///< without folder and ending
  /// The files of the user that the scene has named so far, the scene file included, whether or not they exist.
  const std::vector<std::filesystem::path>& files() const { return files_; }

  /// A file that the scene names at `location`. @throws SceneError  there is no such file, or the scene may not name it.
  SourceText text(const std::string& file, const Location& location) const;
  std::filesystem::path mesh(const std::string& file, const Location& location) const;
  /// A model that is built in, for a built-in scene; null: there is no such model.
  const base::EmbeddedFile* embedded_mesh(const std::string& file) const;
  /// Adds files that belong to the scene: those that its meshes name.
  void add_files(std::span<const std::filesystem::path> files) const;
  std::filesystem::path picture(const std::string& file, const Location& location) const;
  /// The text of a saved state (state_file.h). @throws SceneError
  std::string state(const std::string& file, const Location& location) const;

  /// The folder of the scene file; none: the scene is built in, or in memory.
  const std::optional<std::filesystem::path>& folder() const { return folder_; }

 private:
  std::filesystem::path locate(const std::string& file, const Location& location) const;

  SourceText main_;
  std::optional<std::filesystem::path> folder_;       // none: built in
  std::vector<std::filesystem::path> of_user_;        // files that may be named as well
  mutable std::vector<std::filesystem::path> files_;  // grows as the scene is read
};

}  // namespace softcell::demos
