#pragma once
// The files that a verb reads and writes.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "softcell/base/whole_file.h"

namespace softcell::tool {

/// A file that a command was given, and for what: "--json".
struct NamedFile {
  std::string name;
  std::optional<std::filesystem::path> file;  ///< none: not given
};

/// Whatever way the two paths are spelled. Devices and pipes are nobody's own: nothing is lost in them.
bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// For files that are written, and one that must not be replaced.
/// @throws UsageError  two of them are one file, of which one would be lost.
void check_distinct(const std::vector<NamedFile>& files);

/// For files that are read, of which two may be one, and files that are written.
/// @throws UsageError  one that is read would be replaced.
void check_kept(const std::vector<NamedFile>& read, const std::vector<NamedFile>& written);

/// All of a file that the caller commits. @throws std::runtime_error  it cannot be written.
void write_json(base::WholeFile& file, const nlohmann::ordered_json& document);

}  // namespace softcell::tool
