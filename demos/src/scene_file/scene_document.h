#pragma once
// The document that a scene was read from, kept so that the scene can be saved.

#include <filesystem>
#include <optional>

#include "document/value.h"

namespace softcell::demos {

/// The file of --mesh or --image, which replaces a body.
struct OwnFile {
  std::filesystem::path file;
  bool z_up = false;                       ///< of a model
  std::optional<float> longest_side = {};  ///< of a model, metres; none: that of the body that it replaces
  std::optional<float> tessellation = {};  ///< of a model, cells
};

struct SceneDocument {
  Value root;                                   ///< a table of plain data, also for a scene in Lua
  std::optional<std::filesystem::path> folder;  ///< above all its files; none: the scene is built in
  std::optional<OwnFile> own;                   ///< replaces the first body that can be replaced
};

}  // namespace softcell::demos
