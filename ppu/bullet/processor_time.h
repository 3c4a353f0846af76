#pragma once

#include <chrono>

namespace softcell::ppu {

/// Processor time of the calling thread. Threads that simulate SPEs share the host's cores with it; their time must not count as the PPU's.
std::chrono::nanoseconds processor_time();

}  // namespace softcell::ppu
