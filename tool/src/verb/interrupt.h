#pragma once
// Ctrl-C, asked for at the end of each frame so that no file is left half written.

namespace softcell::tool {

/// While it lives, SIGINT and SIGTERM only set a flag. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool interrupted() const;
};

}  // namespace softcell::tool
