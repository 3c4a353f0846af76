#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace softcell::test {

/// All of a file; nothing of one that cannot be read.
inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace softcell::test
