#pragma once
// The time of one SPE in a timed run.

#include <array>
#include <cstdint>

#include "softcell/ls_sim/timing.h"

namespace softcell::ls_sim {

/// Cycles of the SPU since the first run. The engine advances it to each channel operation, the operation to its end.
/// Used by the thread that runs the SPE.
class SimulatedClock {
 public:
  std::uint64_t now() const { return now_; }

  /// Time went by in which the SPU worked. Never backwards.
  void advance_to(std::uint64_t cycle) {
    if (cycle > now_) now_ = cycle;
  }

  /// The SPU waits until then; not at all if that is over.
  /// @return  whether it waited.
  bool wait_until(std::uint64_t cycle, Stall why) {
    if (cycle <= now_) return false;
    waited_[static_cast<std::size_t>(why)] += cycle - now_;
    all_waits_ += cycle - now_;
    now_ = cycle;
    return true;
  }

  /// All waits so far.
  std::uint64_t waited() const { return all_waits_; }

  /// The waits since the last call, by reason.
  std::array<std::uint64_t, kStalls> take_waits() {
    const auto waits = waited_;
    waited_ = {};
    return waits;
  }

 private:
  std::uint64_t now_ = 0, all_waits_ = 0;
  std::array<std::uint64_t, kStalls> waited_{};
};

}  // namespace softcell::ls_sim
