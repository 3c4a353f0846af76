#pragma once
// Ctrl-C, a request to end and the end of the terminal, asked for between pieces of work so that no file is
// left half written.

namespace softcell::tool {

/// While it lives, SIGINT, SIGTERM and SIGHUP only set a flag; SIGHUP stays ignored where it was, as under
/// nohup. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool interrupted() const;
};

}  // namespace softcell::tool
