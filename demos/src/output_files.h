#pragma once
// The files that a command leaves.

#include <deque>
#include <filesystem>
#include <optional>

#include "softcell/ls_sim/whole_file.h"

namespace softcell::demos {

/// Files that take their places together: none before all are written. Without commit() nothing is left.
class OutputFiles {
 public:
  /// @return  good as long as this. @throws std::runtime_error  naming the file and why it cannot be written.
  ls_sim::WholeFile& open(const std::filesystem::path& file);
  /// Null when none is asked for.
  ls_sim::WholeFile* open(const std::optional<std::filesystem::path>& file);

  /// @throws std::runtime_error  naming the file that cannot be written.
  void commit();

 private:
  std::deque<ls_sim::WholeFile> files_;
};

}  // namespace softcell::demos
