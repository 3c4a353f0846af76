#pragma once
// Files that the build puts into the program: see demos/embed.cmake.

#include <span>
#include <string_view>

namespace softcell::demos {

struct EmbeddedFile {
  std::string_view name;  ///< "arena.toml"
  std::string_view text;
};

/// Of demos/scenes, sorted by name.
std::span<const EmbeddedFile> embedded_scenes();

/// Of demos/report: the page, its style, and its scripts in the order in which they build on each other.
std::span<const EmbeddedFile> embedded_report();

/// @return  null when there is none of that name.
const EmbeddedFile* find_embedded(std::span<const EmbeddedFile> files, std::string_view name);

}  // namespace softcell::demos
