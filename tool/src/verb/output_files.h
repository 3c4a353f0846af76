#pragma once
// The files that a verb writes; one of them may be standard output.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "softcell/base/whole_file.h"
#include "verb_files.h"

namespace softcell::tool {

/// Used instead of a file's name, it means standard output.
inline constexpr std::string_view kStandardOutput = "-";

/// The files that a verb writes. commit() makes all of them appear, after all are written; without commit() none appears. If one of them is
/// standard output, everything printed after the construction goes to standard error, so that a program that reads standard output gets
/// only the file.
class OutputFiles {
 public:
  /// @param files  the files that will be opened, and others that these must not replace.
  /// @throws UsageError  two of them are one file.
  /// @throws std::runtime_error  one of them is standard output, which is closed.
  explicit OutputFiles(const std::vector<NamedFile>& files);

  /// @param file  one of the constructor's files.
  /// @throws std::runtime_error  it cannot be written; the message says why.
  base::WholeFile& open(const std::filesystem::path& file);
  /// Null for no file.
  base::WholeFile* open(const std::optional<std::filesystem::path>& file) {
    return file ? &open(*file) : nullptr;
  }

  /// @throws std::runtime_error  a file cannot be written; the message names it.
  void commit() { files_.commit(); }

 private:
  base::WholeFiles files_;
  int standard_output_ = -1;  ///< a descriptor of standard output, until open() uses it
};

/// @param option  "--record".
/// @throws UsageError  the option's file is standard output, to which the option cannot write.
void refuse_standard_output(const NamedFile& option);

/// The name of a written file in messages.
std::string shown_name(const std::filesystem::path& file);

}  // namespace softcell::tool
