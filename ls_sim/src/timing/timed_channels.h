#pragma once
// The channels of an SPE whose time is simulated: they wait as long as the model says.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/channels.h"
#include "softcell/ls_sim/trace.h"
#include "spe_timer.h"

namespace softcell::ls_sim {

/// How the SPEs of a group keep the order of their clocks. Called by the thread that runs the SPE.
class TimeOrder {
 public:
  virtual ~TimeOrder() = default;

  /// The SPE's next operation is at `now`, and others see what it does at `effect`.
  virtual void set_time(std::uint64_t now, std::uint64_t effect) = 0;
  /// Waits until no other SPE's clock is behind.
  virtual void await_turn() = 0;
  /// When somebody did what the SPE has slept for; 0: it has not slept.
  virtual std::uint64_t woken_at() = 0;
};

/// Passes each operation on to other channels, which do all that there is to do, and then has the clock wait. So results
/// do not depend on the model. A transfer that those channels report as complete is waited for here until the model's
/// is: a program that polls polls until then.
class TimedChannels final : public ChannelPort {
 public:
  /// All outlive this. @param trace  may be null. @param is_big_endian  the byte order of the local store.
  /// @param cycles_per_operation  which the engine does not tell the clock of.
  TimedChannels(ChannelPort& to, SpeTimer& timer, TimeOrder& order, SpeTrace* trace,
                std::span<const std::byte> local_store, bool is_big_endian,
                std::uint32_t cycles_per_operation)
      : to_(to),
        timer_(timer),
        order_(order),
        trace_(trace),
        local_store_(local_store),
        is_big_endian_(is_big_endian),
        cycles_per_operation_(cycles_per_operation) {}

  /// Nanoseconds of the simulated clock.
  static TraceTime nanoseconds(std::uint64_t cycles) {
    constexpr std::uint64_t kPerFiveNanoseconds = 16;
    static_assert(kCyclesPerSecond * 5 == kPerFiveNanoseconds * 1'000'000'000);
    return static_cast<TraceTime>(cycles * 5 / kPerFiveNanoseconds);
  }

  ChannelReply read(std::uint32_t channel) override;
  ChannelReply write(std::uint32_t channel, std::uint32_t value) override;
  ChannelReply count(std::uint32_t channel) override;
  ChannelReply issue(const dma::MfcCommand& command) override;
  void sync() override { to_.sync(); }
  bool stop(std::uint32_t code, dma::LocalStoreAddress assist) override;

 private:
  void arrive();
  void wake(std::uint32_t channel);
  /// @return  whether the SPU waited.
  bool wait_until(std::uint64_t cycle, Stall why, Channel channel);
  void trace_command(const dma::MfcCommand& command, std::uint64_t complete);
  void trace_acknowledged(std::uint32_t tag);

  ChannelPort& to_;
  SpeTimer& timer_;
  TimeOrder& order_;
  SpeTrace* const trace_;
  const std::span<const std::byte> local_store_;
  const bool is_big_endian_;
  const std::uint32_t cycles_per_operation_;
  std::uint32_t tag_mask_ = 0, requested_tags_ = 0, condition_ = 0;
  /// For each tag the command that was issued last and has stalled, as the trace counts.
  std::array<std::optional<std::size_t>, dma::kTagCount> stalled_commands_;
  dma::MfcCommand parameters_{};  ///< as written to channels 16 to 20 so far
};

}  // namespace softcell::ls_sim
