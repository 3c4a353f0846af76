#pragma once
// Counters of one SPE.

#include <array>
#include <chrono>
#include <cstdint>

#include "softcell/dma/mfc.h"

namespace softcell::ls_sim {

/// The channel operations that had to wait.
struct ChannelWaits {
  std::uint64_t count = 0;
  std::chrono::nanoseconds time{0};
};

/// Only channels with numbers below this may make an SPU wait.
inline constexpr std::size_t kWaitingChannels = 31;

/// Sums since the SPE was made.
struct SpeStatistics {
  std::uint64_t jobs = 0;          ///< runs; of a resident kernel, the jobs that it has called
  std::uint64_t image_loads = 0;   ///< by the PPU side
  std::uint64_t instructions = 0;  ///< of programs built for the SPU; those of native kernels are not counted
  std::chrono::nanoseconds busy{0};  ///< in `jobs`
  dma::MfcStatistics dma;
  std::uint64_t channel_waits = 0;  ///< channel operations that blocked, tag waits included
  std::chrono::nanoseconds channel_waiting{0};
  std::array<ChannelWaits, kWaitingChannels> waits{};  ///< the same by the channel's number
  /// The most local store that any run used, in bytes: environment, image and stack. The stack counts as
  /// declared, or as used with SpeOptions::measure_stack.
  std::uint32_t local_store_high_water = 0;
  std::uint32_t stack_high_water = 0;  ///< bytes, the most of any run; only with SpeOptions::measure_stack
};

}  // namespace softcell::ls_sim
