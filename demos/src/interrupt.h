#pragma once
// Ctrl-C, asked for at the end of each frame so that no file is left half written.

namespace softcell::demos {

/// Exit status of what was interrupted, as a shell reports a process that SIGINT ended.
constexpr int kExitInterrupted = 130;

/// While it lives, SIGINT and SIGTERM only set a flag. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool interrupted() const;
};

}  // namespace softcell::demos
