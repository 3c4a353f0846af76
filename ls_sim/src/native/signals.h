#pragma once
// Catches what the processor raises while a kernel runs, and nothing else.

#include <csignal>
#include <cstddef>
#include <memory>

namespace softcell::ls_sim::native {

/// The signal that interrupt() sends to a worker. It is one that the thread sanitizer delivers at once, even
/// to a thread that never calls the library.
inline constexpr int kInterruptSignal = SIGSYS;

/// Installs the handlers once per process. Signals that do not come from a kernel go to the handlers of
/// before.
void install_signal_handlers();

/// Gives the calling thread a stack for signal handlers, for as long as the object lives: a kernel's own
/// stack is in its local store and may be the very thing that is broken.
class SignalStack {
 public:
  SignalStack();
  ~SignalStack();
  SignalStack(const SignalStack&) = delete;
  SignalStack& operator=(const SignalStack&) = delete;

 private:
  static constexpr std::size_t kBytes = 64 * 1024;
  std::unique_ptr<std::byte[]> memory_;
  stack_t previous_{};
};

}  // namespace softcell::ls_sim::native
