#pragma once
// The time base that an SPU's decrementer counts by.

#include <chrono>
#include <cstdint>

#include "softcell/base/assert.h"
#include "softcell/ls_sim/spe_options.h"
#include "timing/simulated_clock.h"

namespace softcell::ls_sim {

/// Ticks of 79.8 MHz, a PS3's time base. Used by the thread that runs the SPE. [lv2] second-hand
class SpuClock {
 public:
  using Host = std::chrono::steady_clock;

  static constexpr std::uint64_t kTicksPerSecond = 79'800'000;
  /// Simulated: what a channel operation and the work around it take; a tick is 40 cycles of the SPU.
  /// Assumed; only a model of the pipelines would settle it.
  static constexpr std::uint64_t kTicksPerOperation = 1;

  /// @param cycles  the simulated clock of a timed SPE, which it then follows; null: there is none. It outlives this.
  explicit SpuClock(Clock kind, SimulatedClock* cycles = nullptr)
      : kind_(kind), begin_(Host::now()), cycles_(cycles) {
    SC_ASSERT(cycles == nullptr || kind == Clock::kSimulated, "clock {} follows cycles", kind);
  }

  Clock kind() const { return kind_; }

  /// A channel operation: simulated time goes by these alone.
  void on_operation() { simulated_ += kTicksPerOperation; }

  /// Simulated time in which nobody had anything to do.
  void skip(std::uint64_t ticks) {
    simulated_ += ticks;
    if (cycles_ != nullptr && ticks != 0)
      cycles_->wait_until(cycles_of(this->ticks() + ticks), Stall::kOtherChannel);
  }

  /// Since the SPE was made.
  std::uint64_t ticks() const {
    if (cycles_ != nullptr) return cycles_->now() * kTicksPerPeriod / kCyclesPerPeriod;
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
  // The smallest numbers that are to each other as 79.8 MHz to 3.2 GHz.
  static constexpr std::uint64_t kTicksPerPeriod = 399, kCyclesPerPeriod = 16000;
  static_assert(kTicksPerPeriod * kCyclesPerSecond == kCyclesPerPeriod * kTicksPerSecond);

  /// The first cycle of a tick.
  static std::uint64_t cycles_of(std::uint64_t tick) {
    return (tick * kCyclesPerPeriod + kTicksPerPeriod - 1) / kTicksPerPeriod;
  }

  Clock kind_;
  Host::time_point begin_;
  std::uint64_t simulated_ = 0;
  SimulatedClock* cycles_;
};

}  // namespace softcell::ls_sim
