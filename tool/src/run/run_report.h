#pragma once
// What a run of a libspe2 program has left: its end, and what libspe2 says of it.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "child_process.h"

namespace softcell::tool {

struct ProgramRun {
  ChildEnd end;
  std::string output;  ///< if it was collected
  /// The messages of those that libspe2 had no time to print, as the process has ended without its exit handlers.
  std::vector<std::string> unsaid_findings;
  nlohmann::json report;  ///< of all its processes together; null: none has made an SPE context

  bool has_findings() const;
  /// "ended with status 0"
  std::string ending() const;
  /// What has to be the same under every order is the end, the output, and which rules were broken where.
  /// @return  what of it the other run has that this one has not: "line 3 of its output is '7', and not '8'"; nothing: all is the same.
  std::optional<std::string> difference(const ProgramRun& other) const;
  /// "2 SPE contexts, 2 runs, 120 DMA commands (1.2 MB), 1 finding"
  std::string summary() const;
  /// The program's status; if that is 0, kExitFindings if a rule was broken.
  int exit_status() const;
};

/// @param reports  what libspe2 has written of each process that has made SPE contexts.
ProgramRun program_run(const ChildEnd& end, std::string output, const std::vector<std::string>& reports);

}  // namespace softcell::tool
