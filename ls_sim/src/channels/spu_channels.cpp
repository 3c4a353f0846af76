#include "spu_channels.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "softcell/base/assert.h"
#include "softcell/ls_sim/channel_name.h"

namespace softcell::ls_sim {
namespace {

constexpr std::chrono::milliseconds kHostStoresPeriod{1};

constexpr std::uint32_t number(Channel channel) { return static_cast<std::uint32_t>(channel); }

ChannelReply reply_of(dma::Fault&& fault) { return {0, std::make_unique<dma::Fault>(std::move(fault))}; }

ChannelReply reply_of(std::optional<dma::Fault> fault) {
  return fault ? reply_of(std::move(*fault)) : ChannelReply{};
}

ChannelReply reply_of(std::variant<std::uint32_t, dma::Fault> status) {
  if (auto* fault = std::get_if<dma::Fault>(&status)) return reply_of(std::move(*fault));
  return {std::get<std::uint32_t>(status), {}};
}

ChannelReply illegal(std::uint32_t channel, const char* operation) {
  dma::Fault fault{dma::Rule::kIllegalChannel};
  fault.detail = std::string(operation) + " channel " + std::to_string(channel) + ", ";
  switch (channel_access(channel)) {
    case ChannelAccess::kNone:
      fault.detail += "which does not exist";
      break;
    case ChannelAccess::kRead:
      fault.detail += std::string(channel_name(channel)) + ", which is only read";
      break;
    case ChannelAccess::kWrite:
      fault.detail += std::string(channel_name(channel)) + ", which is only written";
      break;
  }
  return reply_of(std::move(fault));
}

std::string describe_access(std::uint32_t channel) {
  return (channel_access(channel) == ChannelAccess::kRead ? "read " : "write ") +
         std::string(channel_name(channel));
}

}  // namespace

void SpuChannels::begin_run(bool calls_jobs) {
  calls_jobs_ = calls_jobs;
  in_job_ = false;
  decrementer_ = {};
  srr0_ = 0;
  parameters_ = {};
  lists_ = {};
  has_begun_ = stop_listener_ == nullptr;  // only the side that listens for stops asks for it
}

void SpuChannels::tell_begin() {
  has_begun_ = true;
  const SpeMonitor::Lock lock = to_.monitor.lock();
  to_.registers.has_begun = true;
  to_.monitor.wake_ppu();
}

/// A program that executes a sync has fetched code, or will, to an unknown place. A job loop executes it for jobs, whose images were
/// announced.
void SpuChannels::sync() {
  const bool is_announced = calls_jobs_ && !in_job_ && jobs_are_announced_.load(std::memory_order_relaxed);
  if (!is_announced) to_.mfc.expect_code_everywhere();
}

/// Moves all bytes first: the transfers of the hardware go on while the SPU is stopped.
bool SpuChannels::stop(std::uint32_t code, dma::LocalStoreAddress assist) {
  if (stop_listener_ == nullptr) return false;
  while (move_something()) {
  }
  return stop_listener_->on_stop(code, assist, {(to_.engine.position().value + 1) & dma::kLocalStoreMask});
}

// ---- channel operations

ChannelReply SpuChannels::read(std::uint32_t channel) {
  if (!begin_operation()) return stopped(channel);
  if (channel_access(channel) != ChannelAccess::kRead) return illegal(channel, "read of");
  dma::Mfc& mfc = to_.mfc;
  switch (static_cast<Channel>(channel)) {
    case Channel::kMfcRdTagStat:
      return wait_for_mfc(
          Channel::kMfcRdTagStat, [&] { return mfc.statistics().tag_waits; },
          [&] { return mfc.read_tag_status(); });
    case Channel::kMfcRdListStallStat:
      return wait_for_mfc(
          Channel::kMfcRdListStallStat,
          [&] { return mfc.statistics().get_list.stalls + mfc.statistics().put_list.stalls; },
          [&] { return mfc.read_list_stall_status(); });
    case Channel::kMfcRdAtomicStat:
      return reply_of(mfc.read_atomic_status());
    case Channel::kMfcRdTagMask:
      return {mfc.tag_mask(), {}};
    default:
      return read_register(static_cast<Channel>(channel));
  }
}

ChannelReply SpuChannels::write(std::uint32_t channel, std::uint32_t value) {
  if (!begin_operation()) return stopped(channel);
  if (channel_access(channel) != ChannelAccess::kWrite) return illegal(channel, "write to");
  dma::Mfc& mfc = to_.mfc;
  switch (static_cast<Channel>(channel)) {
    case Channel::kMfcLsa:
      parameters_.lsa.value = value;
      return {};
    case Channel::kMfcEah:
      parameters_.ea.value = (std::uint64_t{value} << 32) | (parameters_.ea.value & 0xFFFFFFFFu);
      return {};
    case Channel::kMfcEal:
      parameters_.ea.value = (parameters_.ea.value & ~std::uint64_t{0xFFFFFFFFu}) | value;
      return {};
    case Channel::kMfcSize:
      parameters_.size = value;
      return {};
    case Channel::kMfcTagId:
      parameters_.tag = value;
      return {};
    case Channel::kMfcCmd:
      parameters_.word = value;
      return issue_now(parameters_);
    case Channel::kMfcWrTagMask:
      mfc.write_tag_mask(value);
      return {};
    case Channel::kMfcWrTagUpdate:
      return reply_of(mfc.write_tag_update(value));
    case Channel::kMfcWrListStallAck:
      return reply_of(mfc.write_list_stall_ack(value));
    default:
      return write_register(static_cast<Channel>(channel), value);
  }
}

ChannelReply SpuChannels::count(std::uint32_t channel) {
  if (!begin_operation()) return stopped(channel);
  if (channel_access(channel) == ChannelAccess::kNone) return illegal(channel, "count of");
  const std::uint32_t slots = count_now(static_cast<Channel>(channel));
  // A loop that only reads counts makes no other call that could return a fault which has occurred meanwhile.
  if (auto fault = to_.mfc.poll_fault()) return reply_of(std::move(fault));
  return {slots, {}};
}

std::uint32_t SpuChannels::count_now(Channel channel) {
  dma::Mfc& mfc = to_.mfc;
  switch (channel) {
    case Channel::kMfcCmd:
      return static_cast<std::uint32_t>(mfc.free_slots());
    case Channel::kMfcRdTagStat:
      return static_cast<std::uint32_t>(mfc.tag_status_count());
    case Channel::kMfcRdListStallStat:
      return static_cast<std::uint32_t>(mfc.list_stall_count());
    case Channel::kMfcRdAtomicStat:
      return static_cast<std::uint32_t>(mfc.atomic_status_count());
    default:
      mfc.visit();
      return count_register(channel);
  }
}

ChannelReply SpuChannels::issue(const dma::MfcCommand& command) {
  if (!begin_operation()) return stopped(number(Channel::kMfcCmd));
  return issue_now(command);
}

// ---- the MFC's channels

ChannelReply SpuChannels::issue_now(const dma::MfcCommand& command) {
  if (command.kind() == dma::CommandKind::kList) {
    lists_[next_list_] = {command, to_.engine.position()};
    next_list_ = (next_list_ + 1) % lists_.size();
  }
  dma::Mfc& mfc = to_.mfc;
  return wait_for_mfc(
      Channel::kMfcCmd, [&] { return mfc.statistics().queue_full_stalls; },
      [&] { return mfc.issue(command); });
}

/// Makes a call of the MFC that may have to wait for transfers, and records the wait. @param waits  the MFC's own count of such waits
template <class Waits, class Call>
ChannelReply SpuChannels::wait_for_mfc(Channel channel, Waits&& waits, Call&& call) {
  // With this schedule nothing waits, and reading the clock would cost as much as the command.
  if (to_.options.schedule.kind == dma::Schedule::kEager) return reply_of(call());
  const std::uint64_t before = waits();
  const auto begin = HostClock::now();
  ChannelReply reply = reply_of(call());
  if (waits() != before) record_wait(channel, begin);
  return reply;
}

// ---- the other channels

ChannelReply SpuChannels::read_register(Channel channel) {
  SpeRegisters& registers = to_.registers;
  switch (channel) {
    case Channel::kSpuRdInMbox:
      return attempt_or_sleep(channel, [&] {
        auto value = registers.in_mbox.read();
        if (value) to_.monitor.wake_ppu();  // it may wait for room
        return value;
      });
    case Channel::kSpuRdSigNotify1:
      return attempt_or_sleep(channel, [&] { return registers.signal1.read(); });
    case Channel::kSpuRdSigNotify2:
      return attempt_or_sleep(channel, [&] { return registers.signal2.read(); });
    case Channel::kSpuRdEventStat:
      return attempt_or_sleep(channel, [&] {
        collect_events();
        return registers.events.read();
      });
    case Channel::kSpuRdEventMask:
      return attempt_or_sleep(channel, [&] { return std::optional(registers.events.mask()); });
    case Channel::kSpuRdDec:
      return attempt_or_sleep(channel, [&] { return std::optional(decrementer_.read(clock_.ticks())); });
    case Channel::kSpuRdSrr0:
      return {srr0_, {}};
    default:  // interrupts are off, and the SPU is not isolated
      SC_ASSERT(channel == Channel::kSpuRdMachStat, "channel {} is read by nobody", channel);
      return {0, {}};
  }
}

ChannelReply SpuChannels::write_register(Channel channel, std::uint32_t value) {
  SpeRegisters& registers = to_.registers;
  constexpr auto kDone = std::optional<std::uint32_t>(0);
  const auto write_mbox = [&](Mailbox<1>& mbox) {
    return attempt_or_sleep(channel, [&]() -> std::optional<std::uint32_t> {
      if (mbox.full()) return std::nullopt;
      mbox.write(value);
      to_.monitor.wake_ppu();
      return kDone;
    });
  };
  switch (channel) {
    case Channel::kSpuWrOutMbox:
      return write_mbox(registers.out_mbox);
    case Channel::kSpuWrOutIntrMbox:
      return write_mbox(registers.out_intr_mbox);
    case Channel::kSpuWrEventMask:
      return attempt_or_sleep(channel, [&] {
        collect_events();
        registers.events.write_mask(value);
        return kDone;
      });
    case Channel::kSpuWrEventAck:
      return attempt_or_sleep(channel, [&] {
        acknowledge_events(value);
        return kDone;
      });
    case Channel::kSpuWrDec:
      return attempt_or_sleep(channel, [&] {
        collect_events();  // an event that the old count has raised stays
        decrementer_.write(value, clock_.ticks());
        return kDone;
      });
    case Channel::kMfcWrMsSyncReq:
      // Transfers of other SPEs into this local store are complete as soon as they are visible, so there is nothing to wait for.
      return attempt_or_sleep(channel, [&] {
        registers.events.raise(event::kMultisourceSync);
        return kDone;
      });
    case Channel::kSpuWrSrr0:
      srr0_ = value;
      return {};
    default:  // bookmarks for tools that watch from outside
      SC_ASSERT(channel >= Channel::kSpuSetBkmkTag, "channel {} is written by nobody", channel);
      return {};
  }
}

std::uint32_t SpuChannels::count_register(Channel channel) {
  const SpeMonitor::Lock lock = to_.monitor.lock();
  SpeRegisters& registers = to_.registers;
  switch (channel) {
    case Channel::kSpuRdEventStat:
      collect_events();
      return registers.events.count();
    case Channel::kSpuRdSigNotify1:
      return registers.signal1.count();
    case Channel::kSpuRdSigNotify2:
      return registers.signal2.count();
    case Channel::kSpuRdInMbox:
      return registers.in_mbox.count();
    case Channel::kSpuWrOutMbox:
      return registers.out_mbox.free_slots();
    case Channel::kSpuWrOutIntrMbox:
      return registers.out_intr_mbox.free_slots();
    default:  // never waits
      return 1;
  }
}

/// @param attempt  with the monitor's lock: the operation's value, or nothing when it has to wait.
template <class Attempt>
ChannelReply SpuChannels::attempt_or_sleep(Channel channel, Attempt&& attempt) {
  to_.mfc.visit();
  if (auto fault = to_.mfc.poll_fault()) return reply_of(std::move(fault));
  {
    const SpeMonitor::Lock lock = to_.monitor.lock();
    if (const auto value = attempt()) return {*value, {}};
  }
  const auto begin = HostClock::now();
  ChannelReply reply = sleep_until(channel, attempt);
  record_wait(channel, begin);
  return reply;
}

template <class Attempt>
ChannelReply SpuChannels::sleep_until(Channel channel, Attempt&& attempt) {
  while (move_something()) {
    const SpeMonitor::Lock lock = to_.monitor.lock();
    if (const auto value = attempt()) return {*value, {}};
  }
  if (auto fault = to_.mfc.poll_fault()) return reply_of(std::move(fault));

  SpeMonitor::Lock lock = to_.monitor.lock();
  for (;;) {
    if (const auto value = attempt()) return {*value, {}};
    if (std::exchange(to_.registers.proxy_issued, false)) {
      lock.unlock();
      while (move_something()) {
      }
      lock.lock();
      continue;
    }
    SC_ASSERT(lock.owns_lock(), "SPE {} is to sleep at channel {} without the lock", to_.spe, channel);
    const Woken woken = to_.monitor.sleep(lock, to_.spe, sleep_at(channel));
    clock_.skip(to_.monitor.slept_ticks(to_.spe));
    switch (woken) {
      case Woken::kToLook:
        if (waits_for_host_stores(channel)) {
          lock.unlock();
          to_.mfc.look_for_host_stores();
          lock.lock();
        }
        break;
      case Woken::kDeadlock: {
        dma::Fault fault{dma::Rule::kDeadlock};
        fault.detail = to_.monitor.deadlock();
        return reply_of(std::move(fault));
      }
      case Woken::kStopped:
        return stopped(number(channel));
    }
  }
}

Sleep SpuChannels::sleep_at(Channel channel) const {
  Sleep sleep{.channel = number(channel), .position = to_.engine.position()};
  const bool timed =
      channel == Channel::kSpuRdEventStat && (to_.registers.events.mask() & event::kDecrementer) != 0;
  if (waits_for_host_stores(channel)) sleep.until = HostClock::now() + kHostStoresPeriod;
  const auto wakes_at = timed ? decrementer_.next_event() : std::nullopt;
  if (!wakes_at) return sleep;
  if (clock_.kind() == Clock::kSimulated) {
    SC_ASSERT(*wakes_at > clock_.ticks(), "SPE {} is to wake at tick {}, and it is tick {}", to_.spe,
              *wakes_at, clock_.ticks());
    sleep.simulated_ticks = *wakes_at - clock_.ticks();
  } else {
    const auto wakes = clock_.host_time_of(*wakes_at);
    sleep.until = std::min(sleep.until.value_or(wakes), wakes);
  }
  return sleep;
}

/// An SPU that waits for the loss of its reservation is woken by stores of other SPEs, but has to look for stores of host threads.
bool SpuChannels::waits_for_host_stores(Channel channel) const {
  return channel == Channel::kSpuRdEventStat &&
         (to_.registers.events.mask() & event::kLostReservation) != 0 && to_.mfc.may_miss_host_stores();
}

// ---- events

void SpuChannels::collect_events() {
  std::uint32_t events = to_.mfc.poll_events();
  if (decrementer_.next_event() && decrementer_.take_event(clock_.ticks())) events |= event::kDecrementer;
  to_.registers.events.raise(events);
}

void SpuChannels::acknowledge_events(std::uint32_t events) {
  collect_events();
  to_.registers.events.acknowledge(events);
  const std::uint32_t masked = ~to_.registers.events.mask();
  if ((events & masked & event::kDecrementer) != 0) decrementer_.stop(clock_.ticks());
}

// ---- ends and waits

std::optional<dma::LocalStoreAddress> SpuChannels::issued_at(const dma::Fault& fault) const {
  if (!fault.command) return std::nullopt;
  const auto list = std::find_if(lists_.begin(), lists_.end(),
                                 [&](const IssuedList& issued) { return issued.command == *fault.command; });
  if (list == lists_.end()) return std::nullopt;
  return list->position;
}

ChannelReply SpuChannels::stopped(std::uint32_t channel) const {
  dma::Fault fault{dma::Rule::kDeadlineExceeded};
  fault.detail = "the kernel did not end in time; it was about to " + describe_access(channel);
  return reply_of(std::move(fault));
}

void SpuChannels::record_wait(Channel channel, HostClock::time_point begin) {
  const auto end = HostClock::now();
  SC_ASSERT(number(channel) < kWaitingChannels && begin <= end, "a wait of SPE {} at channel {}", to_.spe,
            channel);
  ChannelWaits& waits = to_.statistics.waits[number(channel)];
  ++waits.count;
  waits.time += end - begin;
  ++to_.statistics.channel_waits;
  to_.statistics.channel_waiting += end - begin;
  // The waits of a timed SPE are those of the timing model, which writes them to the trace itself.
  if (to_.trace != nullptr && to_.cycles == nullptr) {
    to_.trace->on_wait(number(channel), begin.time_since_epoch().count(), end.time_since_epoch().count());
  }
}

}  // namespace softcell::ls_sim
