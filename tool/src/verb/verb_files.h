#pragma once
// The files that a verb reads and writes.

#include <exception>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "softcell/base/whole_file.h"

namespace softcell::tool {

/// A file of the command line, and the option that names it: "--json".
struct NamedFile {
  std::string name;
  std::optional<std::filesystem::path> file;  ///< none: not given
};

/// Whether two paths lead to the same file, however they are spelled. Devices and pipes never count as the same file, because writing to
/// them overwrites nothing.
bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Checks that no two of these files are the same.
/// @throws UsageError  two of them are.
void check_distinct(const std::vector<NamedFile>& files);

/// Checks that no output replaces a file that is read.
/// @throws UsageError  an output would replace one.
void check_kept(const std::vector<NamedFile>& read, const std::vector<NamedFile>& written);

/// What is wrong with a JSON document, without the prefix "[json.exception....] " of the library that read it.
std::string explanation_of(const std::exception& error);

/// Writes the document as the whole file, which the caller commits. @throws std::runtime_error  it cannot be written.
void write_json(base::WholeFile& file, const nlohmann::ordered_json& document);

}  // namespace softcell::tool
