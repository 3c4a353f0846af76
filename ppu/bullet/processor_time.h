#pragma once

#include <chrono>

namespace softcell::ppu {

/// Processor time of the calling thread. Threads that stand for SPEs share the host's cores with it; what
/// they take is no time of the PPU's.
std::chrono::nanoseconds processor_time();

}  // namespace softcell::ppu
