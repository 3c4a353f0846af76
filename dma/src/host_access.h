#pragma once
// Accesses to the memory of a host program, which may unmap it at any time: a copy that meets an unmapped page
// ends, and the process lives.

#include <setjmp.h>

#include <atomic>
#include <cstdint>

namespace softcell::dma {

/// Once per process: SIGSEGV and SIGBUS of guarded accesses end the access. All others go where they went
/// before. Who installs handlers later has to pass on what is not theirs.
void install_host_access_handlers();

namespace host_access {

struct Guard {
  sigjmp_buf back;
  void* address = nullptr;  ///< of the access that failed
  Guard* outer = nullptr;
};

/// The guard of this thread; null: nothing is guarded.
Guard*& current();

/// Accepts these signals again, which the handler that was left had blocked.
void unblock_signals();

}  // namespace host_access

/// Calls copy(), which accesses memory and does nothing else: it may end in the middle of anything.
/// @pre  install_host_access_handlers() was called
/// @return  whether it came to its end; otherwise `lost` is the address that it could not access.
template <class Copy>
[[gnu::noinline]] bool access_guarded(Copy& copy, std::uint64_t& lost) {
  host_access::Guard guard;
  guard.outer = host_access::current();
  if (sigsetjmp(guard.back, 0) != 0) {
    host_access::current() = guard.outer;
    host_access::unblock_signals();
    lost = reinterpret_cast<std::uint64_t>(guard.address);
    return false;
  }
  host_access::current() = &guard;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  copy();
  std::atomic_signal_fence(std::memory_order_seq_cst);
  host_access::current() = guard.outer;
  return true;
}

}  // namespace softcell::dma
