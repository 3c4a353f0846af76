#pragma once
// What a verb writes, and standard output as one of its files.

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "softcell/base/whole_file.h"
#include "verb_files.h"

namespace softcell::tool {

/// In place of a file's name: standard output.
inline constexpr std::string_view kStandardOutput = "-";

/// The files that a verb writes. They take their places together, none before all are written; without
/// commit() none does. When one of them is standard output, everything that is printed after the construction
/// goes to standard error, so that nothing but the file arrives where a program reads it.
class OutputFiles {
 public:
  /// @param files  those that will be opened, and others that none of them may replace.
  /// @throws UsageError  two of them are one file.
  /// @throws std::runtime_error  standard output is wanted and is closed.
  explicit OutputFiles(const std::vector<NamedFile>& files);

  /// @param file  one of those that were announced.
  /// @throws std::runtime_error  it cannot be written; the sentence says why.
  base::WholeFile& open(const std::filesystem::path& file);
  /// Null when none is asked for.
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
/// @throws UsageError  its file is standard output, which that option cannot write to.
void refuse_standard_output(const NamedFile& option);

/// What to call a file that was written.
std::string shown_name(const std::filesystem::path& file);

}  // namespace softcell::tool
