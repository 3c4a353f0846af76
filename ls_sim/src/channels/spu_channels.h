#pragma once
// All channels of one SPU, over its MFC and its registers.

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>

#include "decrementer.h"
#include "softcell/base/assert.h"
#include "softcell/dma/mfc.h"
#include "softcell/dma/mfc_queue.h"
#include "softcell/dma/proxy_queue.h"
#include "softcell/ls_sim/channels.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/statistics.h"
#include "softcell/ls_sim/trace.h"
#include "spe_monitor.h"
#include "spe_registers.h"
#include "spu_clock.h"

namespace softcell::ls_sim {

/// Is told when the SPU stops with a code that does not end its program; by the thread that runs it.
class StopListener {
 public:
  virtual ~StopListener() = default;

  /// Returns when the SPU is to go on.
  /// @param assist  as ChannelPort::stop(). @param next  the local-store address behind the instruction, as far as the engine knows it.
  /// @return  false: its run is to end.
  virtual bool on_stop(std::uint32_t code, dma::LocalStoreAddress assist, dma::LocalStoreAddress next) = 0;
};

/// Used by the thread that runs the SPE. Before the SPE sleeps, the MFC moves all bytes that it can: the
/// hardware's transfers do not need the SPU.
class SpuChannels final : public ChannelPort {
 public:
  /// What the channels access; all of it outlives them.
  struct Surroundings {
    int spe;
    const SpeOptions& options;
    SpeMonitor& monitor;
    SpeRegisters& registers;  ///< guarded by the monitor
    dma::Mfc& mfc;
    const Engine& engine;  ///< knows where the kernel is
    SpeStatistics& statistics;
    SpeTrace* trace;                   ///< may be null
    SimulatedClock* cycles = nullptr;  ///< of a timed SPE; may be null
  };

  explicit SpuChannels(const Surroundings& surroundings)
      : to_(surroundings), clock_(surroundings.options.clock, surroundings.cycles) {}

  /// Sets the proxy queue, whose commands move at channel operations like the SPU's own. It outlives the
  /// channels.
  void set_proxy(dma::ProxyQueue* proxy) { proxy_ = proxy; }

  /// Null: every stop ends the run. It outlives the channels.
  void set_stop_listener(StopListener* listener) { stop_listener_ = listener; }

  /// State at the start of a program, of all but the MFC and the registers.
  /// @param calls_jobs  the program is one that fetches others and calls them.
  void begin_run(bool calls_jobs);

  /// A job begins or ends. The images that its caller fetches are announced; code that the job itself fetches
  /// is not.
  void begin_job() {
    SC_ASSERT(calls_jobs_ && !in_job_, "a job begins in SPE {}: calls jobs {}, in a job {}", to_.spe,
              calls_jobs_, in_job_);
    in_job_ = true;
  }
  void end_job() {
    SC_ASSERT(in_job_, "a job ends in SPE {}, and none was under way", to_.spe);
    in_job_ = false;
  }

  /// The MFC has been told where the images of jobs end, before they are fetched. Any thread.
  void announce_jobs() { jobs_are_announced_.store(true, std::memory_order_relaxed); }

  /// Completes the proxy queue's commands: they do not need the SPU.
  void end_run() {
    while (proxy_ != nullptr && proxy_->advance()) {
    }
  }

  ChannelReply read(std::uint32_t channel) override;
  ChannelReply write(std::uint32_t channel, std::uint32_t value) override;
  ChannelReply count(std::uint32_t channel) override;
  ChannelReply issue(const dma::MfcCommand& command) override;
  void sync() override;
  bool stop(std::uint32_t code, dma::LocalStoreAddress assist) override;

  /// Where a list command was issued whose element broke a rule: elements execute later, when the kernel is
  /// elsewhere.
  /// @return  nothing for a fault of anything but a list's elements.
  std::optional<dma::LocalStoreAddress> issued_at(const dma::Fault& fault) const;

 private:
  using HostClock = std::chrono::steady_clock;

  /// Where every operation begins. @return  false when the SPE has been stopped.
  bool begin_operation() {
    if (!has_begun_) tell_begin();
    clock_.on_operation();
    if (proxy_ != nullptr) proxy_->visit();
    return to_.monitor.pass_turn(to_.spe);
  }

  // Channels of the MFC.
  template <class Waits, class Call>
  ChannelReply wait_for_mfc(Channel channel, Waits&& waits, Call&& call);
  void tell_begin();
  ChannelReply issue_now(const dma::MfcCommand& command);

  // The other channels.
  ChannelReply read_register(Channel channel);
  ChannelReply write_register(Channel channel, std::uint32_t value);
  std::uint32_t count_now(Channel channel);
  std::uint32_t count_register(Channel channel);
  template <class Attempt>
  ChannelReply attempt_or_sleep(Channel channel, Attempt&& attempt);
  bool move_something() { return to_.mfc.advance() || (proxy_ != nullptr && proxy_->advance()); }
  template <class Attempt>
  ChannelReply sleep_until(Channel channel, Attempt&& attempt);
  Sleep sleep_at(Channel channel) const;
  bool waits_for_host_stores(Channel channel) const;

  // Events; with the monitor's lock.
  void collect_events();
  void acknowledge_events(std::uint32_t events);

  ChannelReply stopped(std::uint32_t channel) const;
  void record_wait(Channel channel, HostClock::time_point begin);

  Surroundings to_;
  dma::ProxyQueue* proxy_ = nullptr;
  StopListener* stop_listener_ = nullptr;
  SpuClock clock_;
  Decrementer decrementer_;
  bool calls_jobs_ = false, in_job_ = false;
  std::atomic<bool> jobs_are_announced_{false};
  std::uint32_t srr0_ = 0;
  bool has_begun_ = true;         ///< whether somebody waits to be told of the run's first operation
  dma::MfcCommand parameters_{};  ///< as written to channels 16 to 20 so far

  struct IssuedList {
    dma::MfcCommand command;
    dma::LocalStoreAddress position;
  };
  std::array<IssuedList, dma::MfcQueue::kSlots> lists_{};  ///< the last that were issued, in a ring
  std::size_t next_list_ = 0;
};

}  // namespace softcell::ls_sim
