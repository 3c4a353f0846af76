#pragma once
// What a run of a libspe2 program has left: its end, and what libspe2 says of it.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "child_process.h"

namespace softcell::tool {

struct ProgramRun {
  ChildEnd end;
  std::string output;     ///< if it was collected
  nlohmann::json report;  ///< null: the program has made no SPE context, or was killed

  bool has_findings() const;
  /// What has to be the same under every order: the end, the output, and which rules were broken where.
  std::string outcome() const;
  /// "2 SPE contexts, 2 runs, 120 DMA commands (1.2 MB), 1 finding"
  std::string summary() const;
  /// The program's status; if that is 0, kExitFindings if a rule was broken.
  int exit_status() const;
};

/// @param report  the text of the file that SOFTCELL_REPORT names; may be empty.
ProgramRun program_run(const ChildEnd& end, std::string output, const std::string& report);

}  // namespace softcell::tool
