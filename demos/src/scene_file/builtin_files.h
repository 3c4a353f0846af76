#pragma once
// The files of demos/scenes, which are part of the command.

#include <span>
#include <string_view>

namespace softcell::demos {

struct BuiltinFile {
  std::string_view name;  ///< "arena.toml"
  std::string_view text;
};

/// Sorted by name. Defined by the build: see demos/scenes/embed.cmake.
std::span<const BuiltinFile> builtin_files();

}  // namespace softcell::demos
