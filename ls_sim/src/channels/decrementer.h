#pragma once
// The SPU's decrementer: 32 bits that count down with the time base.

#include <cstdint>
#include <optional>

#include "softcell/base/assert.h"

namespace softcell::ls_sim {

/// An SPU's decrementer. It does not count by itself: each function gets the time `now` in ticks of SpuClock, which never go back.
/// Used by the thread that runs the SPE. [CBEA, SPU decrementer] documented
class Decrementer {
 public:
  /// SPU_WrDec: loads and starts it.
  void write(std::uint32_t value, std::uint64_t now) {
    SC_ASSERT(now >= since_, "tick {} after tick {}", now, since_);
    running_ = true;
    value_ = value;
    since_ = now;
    next_event_ = now + value + std::uint64_t{1};
  }

  /// SPU_RdDec.
  std::uint32_t read(std::uint64_t now) const {
    SC_ASSERT(now >= since_, "tick {} after tick {}", now, since_);
    return running_ ? value_ - static_cast<std::uint32_t>(now - since_) : value_;
  }

  /// Keeps the value it has now. RPCS3 does so when the event is acknowledged while it is masked.
  void stop(std::uint64_t now) {
    value_ = read(now);
    running_ = false;
  }

  /// Whether it has gone from 0 to 0xFFFFFFFF since the last call: event TM. It counts on from there.
  bool take_event(std::uint64_t now) {
    SC_ASSERT(now >= since_, "tick {} after tick {}", now, since_);
    if (!running_ || now < next_event_) return false;
    next_event_ += ((now - next_event_) / kPeriod + 1) * kPeriod;
    return true;
  }

  /// When it will go from 0 to 0xFFFFFFFF; nothing when it is stopped.
  std::optional<std::uint64_t> next_event() const {
    if (!running_) return std::nullopt;
    return next_event_;
  }

 private:
  static constexpr std::uint64_t kPeriod = std::uint64_t{1} << 32;

  bool running_ = false;
  std::uint32_t value_ = 0;       ///< at `since_`; of a stopped one, now
  std::uint64_t since_ = 0;       ///< ticks
  std::uint64_t next_event_ = 0;  ///< ticks
};

}  // namespace softcell::ls_sim
