#pragma once
// What the SPEs share: main memory, and the ports of each SPE to the bus between them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>

#include "slot_calendar.h"
#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/timing_parameters.h"

namespace softcell::ls_sim {

/// Moves lines of 128 bytes. Each passes the port of the SPE, and main memory or the port of another SPE. The four rings of
/// the bus carry more than six SPEs can ask for. [Kistler, Perrone, Petrini 2006] second-hand
/// Any thread; in the order of simulated time, as SPEs with Interleaving::kByTime call it.
class ElementInterconnect {
 public:
  explicit ElementInterconnect(const TimingParameters& parameters)
      : line_(std::max(parameters.line_cycles, 1u)),
        memory_line_(std::max(parameters.memory_line_cycles, 1u)) {}

  static constexpr int kMainMemory = -1;

  /// @param spe       whose MFC moves the line
  /// @param is_get    into its local store
  /// @param other     the SPE at the other end, or kMainMemory
  /// @param earliest  when its data are there, if nobody else has asked
  /// @return  the cycle in which the line is complete.
  std::uint64_t move_line(int spe, bool is_get, int other, std::uint64_t earliest) {
    const std::lock_guard lock(mutex_);
    SlotCalendar& own = ports_[index(spe)][is_get ? kIn : kOut];
    std::uint64_t at = earliest;
    for (;;) {
      const std::uint64_t before = at;
      at = next_free(own, line_, at);
      at = other == kMainMemory ? next_free(memory_, memory_line_, at)
                                : next_free(ports_[index(other)][is_get ? kOut : kIn], line_, at);
      if (at == before) break;
    }
    own.take(at / line_);
    if (other == kMainMemory) {
      memory_.take(at / memory_line_);
    } else {
      ports_[index(other)][is_get ? kOut : kIn].take(at / line_);
    }
    return at + line_;
  }

  /// No SPE asks for lines before this cycle any more; one that does finds no free slot before it.
  void forget_before(std::uint64_t cycle) {
    const std::lock_guard lock(mutex_);
    memory_.forget_before(cycle / memory_line_);
    for (auto& port : ports_) {
      for (SlotCalendar& direction : port) direction.forget_before(cycle / line_);
    }
  }

 private:
  static constexpr std::size_t kIn = 0, kOut = 1;

  static std::size_t index(int spe) {
    SC_ASSERT(spe >= 0 && spe < dma::kSpeCount, "SPE {}", spe);
    return static_cast<std::size_t>(spe);
  }
  /// The first cycle from `at` on that lies in a free slot.
  static std::uint64_t next_free(const SlotCalendar& calendar, std::uint64_t length, std::uint64_t at) {
    const std::uint64_t slot = calendar.first_free(at / length);
    return std::max(at, slot * length);
  }

  const std::uint64_t line_, memory_line_;
  std::mutex mutex_;  // a run that is stopped goes on out of turn
  SlotCalendar memory_;
  std::array<std::array<SlotCalendar, 2>, dma::kSpeCount> ports_;
};

}  // namespace softcell::ls_sim
