#pragma once
// The options of the command line that say what kernel to run on what.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "kernel_runs/kernel_task.h"

namespace softcell::tool {

class KernelTaskOptions {
 public:
  void add_to(CLI::App& verb);

  /// @throws UsageError  when an option says nothing that is allowed.
  KernelTask task() const;

  /// Image and options as they were given, quoted for a shell.
  std::string text() const;

 private:
  std::string image_;
  std::vector<std::string> in_, out_, inout_, arguments_, in_mbox_;
  std::string deadline_;
  int spes_ = 1;
  bool checked_ = false;
  std::string engine_;  ///< empty: as the image needs
  std::string entry_ = "libspe2";
};

}  // namespace softcell::tool
