#pragma once
// The exit statuses of a verb other than 0.

#include <stdexcept>

namespace softcell::tool {

/// The run has failed, or two runs that must be equal differ.
inline constexpr int kExitFailed = 1;
/// Checked kernels have findings.
inline constexpr int kExitFindings = 3;
/// The run was interrupted: the status that a shell reports for a process that SIGINT ended.
inline constexpr int kExitInterrupted = 130;

/// The command line is wrong: exit status 2. Any other error is a std::runtime_error: exit status 1.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace softcell::tool
