#pragma once
// The time base that an SPU's decrementer counts by.

#include <chrono>
#include <cstdint>

#include "softcell/base/assert.h"
#include "softcell/ls_sim/spe_options.h"

namespace softcell::ls_sim {

/// Ticks of 79.8 MHz, a PS3's time base. Used by the thread that runs the SPE. [lv2] second-hand
class SpuClock {
 public:
  using Host = std::chrono::steady_clock;

  static constexpr std::uint64_t kTicksPerSecond = 79'800'000;
  /// Simulated: what a channel operation and the work around it take; a tick is 40 cycles of the SPU.
  /// Assumed; only a model of the pipelines would settle it.
  static constexpr std::uint64_t kTicksPerOperation = 1;

  explicit SpuClock(Clock kind) : kind_(kind), begin_(Host::now()) {}

  Clock kind() const { return kind_; }

  /// A channel operation: simulated time goes by these alone.
  void on_operation() { simulated_ += kTicksPerOperation; }

  /// Simulated time in which nobody had anything to do.
  void skip(std::uint64_t ticks) { simulated_ += ticks; }

  /// Since the SPE was made.
  std::uint64_t ticks() const {
    return kind_ == Clock::kSimulated ? simulated_ : to_ticks(Host::now() - begin_);
  }

  /// When the host's clock will have reached `ticks`, or shortly after.
  Host::time_point host_time_of(std::uint64_t ticks) const {
    const std::uint64_t seconds = ticks / kTicksPerSecond, rest = ticks % kTicksPerSecond;
    return begin_ + std::chrono::seconds(seconds) +
           std::chrono::nanoseconds(rest * kNanoseconds / kTicksPerSecond + 1);
  }

  static std::uint64_t to_ticks(std::chrono::nanoseconds time) {
    SC_ASSERT(time.count() >= 0, "{} ns since the SPE was made", time.count());
    const auto nanoseconds = static_cast<std::uint64_t>(time.count());
    // In two parts, so that no product passes 64 bits.
    return nanoseconds / kNanoseconds * kTicksPerSecond +
           nanoseconds % kNanoseconds * kTicksPerSecond / kNanoseconds;
  }

 private:
  static constexpr std::uint64_t kNanoseconds = 1'000'000'000;

  Clock kind_;
  Host::time_point begin_;
  std::uint64_t simulated_ = 0;
};

}  // namespace softcell::ls_sim
