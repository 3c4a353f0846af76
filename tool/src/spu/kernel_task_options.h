#pragma once
// The command line options that state which kernel to run with which data.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "kernel_runs/kernel_task.h"

namespace softcell::tool {

class KernelTaskOptions {
 public:
  void add_to(CLI::App& verb);

  /// @throws UsageError  an option's value is not allowed.
  KernelTask task() const;

  /// Image and options as they were given, quoted for a shell.
  std::string text() const;

 private:
  std::string image_;
  std::vector<std::string> in_, out_, inout_, arguments_, in_mbox_;
  std::string deadline_;
  int spes_ = 1;
  bool checked_ = false;
  std::string engine_;  ///< empty: the one that the image needs
  std::string entry_ = "libspe2";
};

}  // namespace softcell::tool
