#pragma once
// The result of a run of a libspe2 program: how it ended, and what libspe2 reports of it.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "child_process.h"

namespace softcell::tool {

struct ProgramRun {
  ChildEnd end;
  std::string output;  ///< if it was collected
  /// The messages of findings that libspe2 had no time to print, because the process ended without its exit handlers.
  std::vector<std::string> unsaid_findings;
  nlohmann::json report;      ///< of all its processes together; null: no process has made an SPE context
  std::size_t processes = 0;  ///< of the program, that have made SPE contexts
  std::vector<std::string> traces = {};  ///< of those processes that have written one, if they are wanted

  bool has_findings() const;
  /// "ended with status 0"
  std::string ending() const;
  /// The end, the output, and which rules were broken where must be the same under every order.
  /// @return  the first thing that differs in the other run: "line 3 of its output is '7', and not '8'"; none: all is the same.
  std::optional<std::string> difference(const ProgramRun& other) const;
  /// "2 SPE contexts, 2 runs, 120 DMA commands (1.2 MB), 1 finding"
  std::string summary() const;
  /// The program's status; if that is 0 and a rule was broken, kExitFindings.
  int exit_status() const;
};

/// @param reports  the reports that libspe2 has written, one for each process that has made SPE contexts.
ProgramRun program_run(const ChildEnd& end, std::string output, const std::vector<std::string>& reports);

}  // namespace softcell::tool
