#pragma once
// What an SPE has done.

#include <chrono>
#include <cstdint>

#include "softcell/dma/mfc.h"

namespace softcell::ls_sim {

/// Sums since the SPE was made.
struct SpeStatistics {
  std::uint64_t jobs = 0;  ///< runs
  std::uint64_t image_loads = 0;
  std::chrono::nanoseconds busy{0};
  dma::MfcStatistics dma;
  std::uint64_t channel_waits = 0;  ///< channel operations that blocked, tag waits included
  std::chrono::nanoseconds channel_waiting{0};
  std::uint32_t stack_high_water = 0;  ///< bytes, the most of any run; only with SpeOptions::measure_stack
};

}  // namespace softcell::ls_sim
