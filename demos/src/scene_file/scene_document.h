#pragma once
// What a scene was read from, kept to be saved again.

#include <filesystem>
#include <optional>

#include "document/value.h"

namespace softcell::demos {

/// The file of --mesh or --image, which takes the place of a body.
struct OwnFile {
  std::filesystem::path file;
  bool z_up = false;                       ///< of a model
  std::optional<float> longest_side = {};  ///< of a model, metres; none: of what it replaces
  std::optional<float> tessellation = {};  ///< of a model, cells
};

struct SceneDocument {
  Value root;                                   ///< a table: plain data, also of a scene in Lua
  std::optional<std::filesystem::path> folder;  ///< below which its files are; none: it is built in
  std::optional<OwnFile> own;                   ///< in place of the first body that lets one be
};

}  // namespace softcell::demos
