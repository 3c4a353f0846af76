// Each SPU thread has a host thread, which waits for its SPE to stop; the group has one that answers what its threads
// send through their interrupt mailboxes, and that ends the group:
//
//   SPU thread 0  context ---- stop 0x110 (receive) -- answer -- resume ---- stop 0x102 (exit)
//   SPU thread 1  context ---- interrupt mailbox: send event ----------------------- stop 0x102
//   service                          event to its queue, reply          all have ended: the group has

#include "group_run.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ppu/libspe2/cause.h"
#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/fault.h"

namespace softcell::psl1ght {
namespace {

using ls_sim::ContextStop;

// Stop codes and messages of an SPU thread to lv2. [PSL1GHT, libsputhread; RPCS3] second-hand
constexpr std::uint32_t kStopYield = 0x100, kStopGroupExit = 0x101, kStopThreadExit = 0x102,
                        kStopReceive = 0x110, kStopTryReceive = 0x111;
constexpr std::uint32_t kMessageShift = 24, kMessageData = 0xFFFFFF, kThrow = 64, kEndOfPorts = 128;
constexpr std::uint64_t kPortShift = 32;

constexpr std::chrono::milliseconds kGangStart{1000};
constexpr std::chrono::milliseconds kInterruptAgain{1};

u32 read_mailbox(SpuThread& thread) { return thread.context->problem_state().read_out_mbox().value_or(0); }

/// What lv2's events call the cause of an exception.
u32 exception_of(const dma::Fault& fault) {
  using libspe2::Cause;
  switch (libspe2::cause_of(fault.rule)) {
    case Cause::kDmaAlignment:
      return SPU_EXCEPTION_DMA_ALIGNMENT;
    case Cause::kDmaCommand:
      return SPU_EXCEPTION_DMA_COMMAND;
    case Cause::kSegment:
      return SPU_EXCEPTION_MFC_SEGMENT;
    case Cause::kStorage:
      return SPU_EXCEPTION_MFC_STORAGE;
    case Cause::kHalt:
      return SPU_EXCEPTION_HALT;
    case Cause::kInstruction:
    case Cause::kChannel:
    case Cause::kOnlySoftcell:
      break;
  }
  return SPU_EXCEPTION_SPU_ERROR;
}

/// Ends the group because a thread of it has faulted or stopped with an unknown code.
void fail(Group& group, const SpuThread& thread, const dma::Fault& fault, u32 exception) {
  Lv2& lv2 = Lv2::get();
  std::shared_ptr<Queue> queue;
  {
    const std::lock_guard lock(lv2.mutex);
    if (group.ending) return;  // it was told to
    queue = group.exception_events;
  }
  report_fault(fault, queue != nullptr);
  const std::lock_guard lock(lv2.mutex);
  if (queue != nullptr && !Machine::get().is_ending())
    lv2.send(*queue, {SPU_THREAD_GROUP_EVENT_EXCEPTION_KEY, group.number, thread.number, exception});
  end_group(group, {SPU_THREAD_GROUP_JOIN_TERMINATED, exception});
}

/// Sends the SPU thread the next event of the queue whose number is in its mailbox.
/// @return  false: the group ends meanwhile.
bool answer_receive(const Group& group, SpuThread& thread, bool waits) {
  Lv2& lv2 = Lv2::get();
  const u32 number = read_mailbox(thread);
  sys_event_t event{};
  std::uint32_t error = kOk;
  {
    std::unique_lock lock(lv2.mutex);
    const auto found = thread.queues.find(number);
    if (found == thread.queues.end()) {
      error = kInvalid;
    } else if (const std::shared_ptr<Queue> queue = found->second; waits) {
      error = lv2.receive(lock, queue, event, 0, [&] { return group.ending; });
    } else if (queue->events.empty()) {
      error = kBusy;
    } else {
      error = lv2.receive(lock, queue, event, 0, [] { return false; });
    }
    if (group.ending) return false;
  }
  ls_sim::ProblemState& state = thread.context->problem_state();
  state.write_in_mbox(error);
  if (error != kOk) return true;
  for (const u64 value : {event.data_1, event.data_2, event.data_3})
    state.write_in_mbox(static_cast<u32>(value));
  return true;
}

/// What lv2 does about a stop. @return  whether the thread goes on.
bool answer_stop(Group& group, SpuThread& thread, const ContextStop& stop) {
  Lv2& lv2 = Lv2::get();
  if (stop.result.fault) {
    fail(group, thread, *stop.result.fault, exception_of(*stop.result.fault));
    return false;
  }
  switch (stop.result.stop_code) {
    case kStopYield:
      return stop.goes_on;
    case kStopGroupExit: {
      const u32 status = read_mailbox(thread);
      const std::lock_guard lock(lv2.mutex);
      end_group(group, {SPU_THREAD_GROUP_JOIN_GROUP_EXIT, status});
      return false;
    }
    case kStopThreadExit: {
      const u32 status = read_mailbox(thread);
      const std::lock_guard lock(lv2.mutex);
      thread.exit_status = static_cast<s32>(status);
      return false;
    }
    case kStopReceive:
      return stop.goes_on && answer_receive(group, thread, true);
    case kStopTryReceive:
      return stop.goes_on && answer_receive(group, thread, false);
    default:
      break;
  }
  if (stop.result.ended_normally()) {  // main has returned: newlib's end of a program
    const std::lock_guard lock(lv2.mutex);
    thread.exit_status = static_cast<s32>(stop.result.status());
    return false;
  }
  dma::Fault fault{
      .rule = dma::Rule::kIllegalInstruction,
      .spe = thread.context->number(),
      .kernel = thread.image->name,
      .detail = "lv2 has no service for a stop with code " + std::to_string(stop.result.stop_code)};
  fail(group, thread, fault, SPU_EXCEPTION_STOP_CALL);
  return false;
}

void tell_service(Group& group) {
  ++group.changes;
  Machine::get().contexts().wake();
}

/// Ends the group because the host has failed.
void end_by_exception(Group& group, const std::exception& error) {
  Machine::complain(error.what());
  const std::lock_guard lock(Lv2::get().mutex);
  end_group(group, {SPU_THREAD_GROUP_JOIN_TERMINATED, SPU_EXCEPTION_NO_VALUE});
}

/// On the thread's own host thread.
void run_thread(Group& group, SpuThread& thread) {
  try {
    ContextStop stop = thread.context->run(thread.arguments);
    thread.has_stopped = true;
    Machine::get().contexts().wake();
    while (answer_stop(group, thread, stop)) stop = thread.context->resume();
  } catch (const std::exception& error) {
    end_by_exception(group, error);
  }
  thread.ended = true;
  tell_service(group);
}

/// A message that the thread has sent through its interrupt mailbox.
void answer_message(SpuThread& thread, u32 message) {
  Lv2& lv2 = Lv2::get();
  const u32 request = message >> kMessageShift;
  const u32 data1 = read_mailbox(thread);
  std::uint32_t error = kNotSupported;
  if (request < kEndOfPorts) {
    const auto number = static_cast<std::uint8_t>(request % kThrow);
    const std::lock_guard lock(lv2.mutex);
    const auto found = thread.ports.find(number);
    error = found == thread.ports.end() || found->second->destroyed
                ? static_cast<std::uint32_t>(kNotConnected)
                : lv2.send(*found->second, {SPU_THREAD_EVENT_USER_KEY, thread.number,
                                            u64{number} << kPortShift | (message & kMessageData), data1});
  } else {
    Machine::complain("an SPU thread sends lv2 the message " + std::to_string(request) +
                      " of event flags, which softcell does not have");
  }
  if (request < kThrow || request == kEndOfPorts) thread.context->problem_state().write_in_mbox(error);
}

/// Answers until all threads have ended.
void serve(const std::shared_ptr<Group>& group) {
  Lv2& lv2 = Lv2::get();
  ls_sim::SpeContexts& contexts = Machine::get().contexts();
  const auto messages = [&] {
    bool any = false;
    for (const auto& thread : group->threads) {
      while (const auto message = thread->context->problem_state().read_out_intr_mbox()) {
        any = true;
        try {
          answer_message(*thread, *message);
        } catch (const std::exception& error) {
          end_by_exception(*group, error);
        }
      }
    }
    return any;
  };
  for (;;) {
    const std::uint64_t seen = group->changes;
    if (messages()) continue;
    bool ending = false;
    {
      const std::lock_guard lock(lv2.mutex);
      ending = group->ending;
    }
    if (std::ranges::all_of(group->threads, [](const auto& thread) { return thread->ended.load(); })) {
      if (messages()) continue;  // the last words
      break;
    }
    std::optional<std::chrono::steady_clock::time_point> until;
    if (ending) {
      for (const auto& thread : group->threads) thread->context->interrupt();
      until = std::chrono::steady_clock::now() + kInterruptAgain;  // one was perhaps about to start
    }
    contexts.wait(
        [&] {
          return group->changes != seen || std::ranges::any_of(group->threads, [](const auto& thread) {
                   return thread->context->state_in_wait().out_intr_mbox != 0;
                 });
        },
        until);
  }
  for (const auto& thread : group->threads) {
    Machine::get().count_last(*thread->context);
  }
  Machine::get().stay_if_ending();
  const std::lock_guard lock(lv2.mutex);
  group->runs = false;
  group->end = group->ending ? group->ending_with : Group::End{SPU_THREAD_GROUP_JOIN_ALL_THREADS_EXIT, 0};
  lv2.changed.notify_all();
}

void make_contexts(Group& group) {
  Machine& machine = Machine::get();
  for (const auto& thread : group.threads) {
    thread->context.reset();
  }
  std::vector<dma::EffectiveAddress> places;
  for (const auto& thread : group.threads) {
    thread->context = machine.contexts().create();
    if (thread->context == nullptr) throw std::runtime_error("all 256 SPE contexts are in use");
    machine.count_context();
    thread->context->load(thread->image);
    configure_signals(*thread);
    places.push_back(thread->context->problem_state().local_store_ea());
  }
  for (const auto& thread : group.threads) {
    const auto own = static_cast<std::uint32_t>(
        reinterpret_cast<std::uintptr_t>(thread->context->problem_state().local_store().data()));
    thread->context->set_window({own, places});
  }
}

}  // namespace

void configure_signals(SpuThread& thread) {
  using ls_sim::SignalMode;
  SC_ASSERT(thread.context != nullptr, "signal modes {} of a thread without a context", thread.configuration);
  ls_sim::ProblemState& state = thread.context->problem_state();
  const auto mode = [&](u64 bit) {
    return (thread.configuration & bit) != 0 ? SignalMode::kOr : SignalMode::kOverwrite;
  };
  state.set_signal_mode(1, mode(SPU_SIGNAL1_OR));
  state.set_signal_mode(2, mode(SPU_SIGNAL2_OR));
}

void end_group(Group& group, Group::End end) {
  if (group.ending || !group.runs) return;
  group.ending = true;
  group.ending_with = end;
  Lv2::get().changed.notify_all();
  tell_service(group);
}

std::uint32_t start_group(std::unique_lock<std::mutex>& lock, const std::shared_ptr<Group>& group) {
  if (group->runs) return kWrongState;
  for (const auto& thread : group->threads) {
    if (thread == nullptr) return kWrongState;
  }
  make_contexts(*group);
  group->runs = true;
  group->ending = false;
  group->end.reset();
  for (const auto& thread : group->threads) {
    thread->exit_status.reset();
    thread->ended = false;
    thread->has_stopped = false;
  }
  if (group->run_events != nullptr)
    Lv2::get().send(*group->run_events, {SPU_THREAD_GROUP_EVENT_RUN_KEY, group->number, 0, 0});
  lock.unlock();
  for (const auto& thread : group->threads) {
    Machine::get().count_run();
    thread->host = std::jthread([group, &one = *thread] { run_thread(*group, one); });
  }
  group->service = std::jthread([group] { serve(group); });
  // lv2 runs the threads of a group at the same time, so that each is at work before anybody else has done much.
  Machine::get().contexts().wait(
      [&] {
        return std::ranges::all_of(group->threads, [](const auto& thread) {
          return thread->has_stopped || thread->context->state_in_wait().has_begun;
        });
      },
      std::chrono::steady_clock::now() + kGangStart);
  lock.lock();
  return kOk;
}

}  // namespace softcell::psl1ght
