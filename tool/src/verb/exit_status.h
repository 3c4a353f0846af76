#pragma once
// How a verb ends that does not end with 0.

#include <stdexcept>

namespace softcell::tool {

/// Checked kernels have findings.
inline constexpr int kExitFindings = 3;
/// What was interrupted, as a shell reports a process that SIGINT ended.
inline constexpr int kExitInterrupted = 130;

/// The command was called in a way that it does not have: exit status 2. Anything else that goes wrong is a
/// std::runtime_error: exit status 1.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace softcell::tool
