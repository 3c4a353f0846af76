#pragma once
// Processor time of the calling thread.

#include <chrono>

namespace softcell::ppu {

/// Processor time of the calling thread. Threads that simulate SPEs share the host's cores with it; their time must not count as the PPU's.
std::chrono::nanoseconds processor_time();

/// Adds the processor time of work() to `time`.
template <typename Work>
void timed(std::chrono::nanoseconds& time, const Work& work) {
  const auto begin = processor_time();
  work();
  time += processor_time() - begin;
}

}  // namespace softcell::ppu
