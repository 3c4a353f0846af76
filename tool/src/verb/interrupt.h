#pragma once
// Ctrl-C, SIGTERM and SIGHUP as a flag that is polled between pieces of work, so that no file is left half written.

namespace softcell::tool {

/// While an object of this class exists, SIGINT, SIGTERM and SIGHUP only set a flag. SIGHUP stays ignored if it was
/// ignored before, as under nohup. At most one object exists at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool interrupted() const;
};

}  // namespace softcell::tool
