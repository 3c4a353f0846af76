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

/// Stands for standard output in place of a file's name.
inline constexpr std::string_view kStandardOutput = "-";

/// The files that a verb writes. commit() makes all of them appear, after all are written; without commit() none
/// appears. If one of them is standard output, everything that is printed after the construction goes to standard
/// error, so that a program that reads standard output gets the file alone.
class OutputFiles {
 public:
  /// @param files  the files that will be opened, and others that these must not replace.
  /// @throws UsageError  two of them are one file.
  /// @throws std::runtime_error  standard output is wanted and is closed.
  explicit OutputFiles(const std::vector<NamedFile>& files);

  /// @param file  one of the constructor's.
  /// @throws std::runtime_error  it cannot be written; the sentence says why.
  base::WholeFile& open(const std::filesystem::path& file);
  /// Null for no file.
  base::WholeFile* open(const std::optional<std::filesystem::path>& file) {
    return file ? &open(*file) : nullptr;
  }

  /// @throws std::runtime_error  naming the file that cannot be written.
  void commit() { files_.commit(); }

 private:
  base::WholeFiles files_;
  int standard_output_ = -1;  ///< a descriptor of it, until it is opened
};

/// @param option  "--record".
/// @throws UsageError  the option's file is standard output, and the option cannot write to that.
void refuse_standard_output(const NamedFile& option);

/// How messages call a file that was written.
std::string shown_name(const std::filesystem::path& file);

}  // namespace softcell::tool
