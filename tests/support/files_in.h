#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace softcell::test {

/// The names of what is in a folder.
inline std::set<std::string> files_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

}  // namespace softcell::test
