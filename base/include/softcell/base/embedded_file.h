#pragma once
// Files that the build puts into a program: see cmake/SoftcellEmbed.cmake.

#include <algorithm>
#include <span>
#include <string_view>

namespace softcell::base {

/// An embedded file, in the program's memory.
struct EmbeddedFile {
  std::string_view name;  ///< "arena.toml"
  std::string_view text;
};

/// @return  the file of that name, or null.
inline const EmbeddedFile* find_embedded(std::span<const EmbeddedFile> files, std::string_view name) {
  const auto found = std::ranges::find(files, name, &EmbeddedFile::name);
  return found == files.end() ? nullptr : &*found;
}

}  // namespace softcell::base
