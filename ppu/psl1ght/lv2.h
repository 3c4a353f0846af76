#pragma once
// What lv2 keeps for a program: its objects by their numbers.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include "libspe2.h"  // before sys/spu.h, whose macros are names of its members
#include "ppu/libspe2/machine.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_contexts.h"
#include "sys/event_queue.h"
#include "sys/spu.h"

struct spe_context;

namespace softcell::psl1ght {

using libspe2::Machine;

/// Results of lv2's calls. [lv2; RPCS3] second-hand
enum Error : std::uint32_t {
  kOk = 0,
  kAgain = 0x80010001,
  kInvalid = 0x80010002,
  kNotSupported = 0x80010003,
  kNoMemory = 0x80010004,
  kNoSuchObject = 0x80010005,
  kNoSuchFile = 0x80010006,
  kNoProgram = 0x80010007,
  kBusy = 0x8001000A,
  kTimedOut = 0x8001000B,
  kFault = 0x8001000D,
  kWrongState = 0x8001000F,
  kCancelled = 0x80010013,
  kExists = 0x80010014,
  kConnected = 0x80010015,
  kNotConnected = 0x80010016,
};
inline s32 result(std::uint32_t error) { return static_cast<s32>(error); }

/// The most threads of a group, and SPUs of a program: those that the console leaves to games.
inline constexpr u32 kMostSpus = 6;
inline constexpr std::uint8_t kPorts = 64;
/// The bits of an SPU's signal mode: each register overwrites, or ORs.
inline constexpr u64 kSignalModes = SPU_SIGNAL1_OR | SPU_SIGNAL2_OR;

struct Queue {
  const s32 type;
  const std::uint64_t key;
  const std::size_t room;
  // Guarded by the mutex of Lv2:
  std::deque<sys_event_t> events;
  int waiting = 0;
  bool destroyed = false;
};

struct Port {
  u32 number = 0;
  std::uint64_t name = 0;
  std::shared_ptr<Queue> queue;  ///< null: not connected
};

/// An SPU thread of a group. Guarded by the mutex of Lv2, but for what its own host thread uses.
struct SpuThread {
  u32 number = 0, index = 0;
  std::shared_ptr<const ls_sim::KernelImage> image;
  ls_sim::EntryArguments arguments;
  std::uint64_t configuration = 0;
  std::map<std::uint8_t, std::shared_ptr<Queue>> ports;  ///< of events that it sends
  std::map<u32, std::shared_ptr<Queue>> queues;          ///< that it receives from
  std::optional<s32> exit_status;
  std::atomic<bool> ended{true};
  std::atomic<bool> has_stopped{false};  ///< since it was started
  /// The context of the last start; it is never replaced while the group runs.
  std::unique_ptr<ls_sim::SpeContext> context;
  std::jthread host;
};

struct Group {
  u32 number = 0, priority = 0;
  std::vector<std::unique_ptr<SpuThread>> threads;  ///< by index; null: not initialized
  // Guarded by the mutex of Lv2:
  bool runs = false;
  bool ending = false;  ///< its threads are told to end
  bool joined = false;  ///< somebody waits for its end
  struct End {
    u32 cause = 0, status = 0;
  };
  std::optional<End> end;  ///< of the last run, until somebody joins
  End ending_with;         ///< what is going to be its end
  std::shared_ptr<Queue> run_events, exception_events;
  std::atomic<std::uint64_t> changes{0};  ///< of a thread's end, or of `ending`
  std::jthread service;                   ///< answers the threads' messages, and ends the run
};

struct RawSpu {
  std::shared_ptr<spe_context> context;
  u32 signal_mode = 0;
  std::uint64_t masks[3] = {};
  // Guarded by the mutex of Lv2:
  bool runs = false, goes_on = false, stopping = false;
  u32 status = 0, next_pc = 0;
  std::jthread host;
};

/// The one object of the process, never destroyed: threads may outlive main(). Any thread.
class Lv2 {
 public:
  static Lv2& get();

  std::mutex mutex;  // guards all below
  std::condition_variable changed;
  std::map<u32, std::shared_ptr<Queue>> queues;
  std::map<u32, Port> ports;
  std::map<u32, std::shared_ptr<Group>> groups;
  std::map<u32, std::pair<std::shared_ptr<Group>, SpuThread*>> threads;
  std::map<u32, std::shared_ptr<RawSpu>> raw_spus;  ///< by the number of their contexts
  u32 raw_room = 0;
  u32 last_number = 0;

  /// Return the object with this number, with the lock; null: there is none.
  std::shared_ptr<Queue> queue(u32 number);
  std::shared_ptr<Group> group(u32 number);

  /// Puts an event into a queue, with the lock. @return  kOk, or kBusy: it is full
  std::uint32_t send(Queue& queue, const sys_event_t& event);

  /// Removes the oldest event of the queue; waits for one first. With the lock.
  /// @param stopped  looked at whenever something has changed; then the wait ends with kCancelled.
  template <class Stopped>
  std::uint32_t receive(std::unique_lock<std::mutex>& lock, const std::shared_ptr<Queue>& from,
                        sys_event_t& event, std::uint64_t microseconds, Stopped&& stopped);
};

template <class Stopped>
std::uint32_t Lv2::receive(std::unique_lock<std::mutex>& lock, const std::shared_ptr<Queue>& from,
                           sys_event_t& event, std::uint64_t microseconds, Stopped&& stopped) {
  const auto ready = [&] { return !from->events.empty() || from->destroyed || stopped(); };
  ++from->waiting;
  bool is_ready = true;
  if (microseconds == 0) {
    changed.wait(lock, ready);
  } else {
    // As long as a clock can count.
    constexpr std::uint64_t kMost = 1'000'000ull * 60 * 60 * 24 * 365;
    is_ready = changed.wait_for(lock, std::chrono::microseconds(std::min(microseconds, kMost)), ready);
  }
  --from->waiting;
  if (!is_ready) return kTimedOut;
  if (from->events.empty()) return kCancelled;
  event = from->events.front();
  from->events.pop_front();
  return kOk;
}

/// What a kernel has done wrong ends the program, unless `handled`: lv2 would end it.
void report_fault(const dma::Fault& fault, bool handled);

/// Says why a function is not there. @return  kNotSupported
std::uint32_t refuse(std::string_view function, std::string_view reason);

/// Calls work() for a function of the C interface: turns exceptions into lv2's error codes.
template <class Work>
s32 call(Work&& work) {
  try {
    return result(work());
  } catch (const std::bad_alloc&) {
    return result(kNoMemory);
  } catch (const std::exception& error) {
    Machine::complain(error.what());
    return result(kAgain);
  }
}

}  // namespace softcell::psl1ght
