// Running contexts, and why they stop.

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include "callbacks.h"
#include "cause.h"
#include "libspe2.h"
#include "object.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/fault.h"
#include "softcell/ls_sim/channels.h"

using softcell::dma::Fault;
using softcell::libspe2::Cause;
using softcell::libspe2::fail;
using softcell::libspe2::Machine;
using softcell::libspe2::Waits;
using softcell::libspe2::with_context;
using softcell::ls_sim::ContextStop;
using softcell::ls_sim::EntryArguments;
using softcell::ls_sim::kAssistedCalls;
using softcell::ls_sim::RunResult;

namespace {

/// How many unread stops are kept; then the oldest is dropped. The original keeps them in a pipe of 64 KB.
constexpr std::size_t kMostStops = 65536 / sizeof(spe_stop_info_t);
constexpr unsigned int kRunFlags = SPE_RUN_USER_REGS | SPE_NO_CALLBACKS;
constexpr int kNoHandler = -1;                // what a call without a handler has failed with
constexpr std::uint32_t kCallnumMask = 0xFF;  // [libspe2, newlib] documented
constexpr int kStatusStopped = 0x2, kStatusHalted = 0x4,
              kStatusCodeShift = 16;  // SPU_Status [CBEA] documented

struct Outcome {
  spe_stop_info_t info{};
  int result = 0;
  int error = 0;  ///< errno, with a result of -1
};

Outcome failure(unsigned int reason, int what, int spu_status, int error) {
  Outcome outcome;
  outcome.info.stop_reason = reason;
  outcome.info.result.spe_runtime_error = what;  // the members of the union that are ints are one
  outcome.info.spu_status = spu_status;
  outcome.result = -1;
  outcome.error = error;
  return outcome;
}

/// What spe_context_run() returns on the Cell's Linux for this fault.
Outcome outcome_of(const Fault& fault) {
  switch (cause_of(fault.rule)) {
    case Cause::kDmaAlignment:
      return failure(SPE_RUNTIME_EXCEPTION, SPE_DMA_ALIGNMENT, -1, EIO);
    case Cause::kDmaCommand:
      return failure(SPE_RUNTIME_EXCEPTION, SPE_INVALID_DMA, -1, EIO);
    case Cause::kSegment:
      return failure(SPE_RUNTIME_EXCEPTION, SPE_DMA_SEGMENTATION, -1, EIO);
    case Cause::kStorage:
      return failure(SPE_RUNTIME_EXCEPTION, SPE_DMA_STORAGE, -1, EIO);
    case Cause::kHalt:
      return failure(SPE_RUNTIME_ERROR, SPE_SPU_HALT, kStatusHalted, EFAULT);
    case Cause::kInstruction:
      return failure(SPE_RUNTIME_ERROR, SPE_SPU_INVALID_INSTR, SPE_SPU_INVALID_INSTR, EFAULT);
    case Cause::kChannel:
      return failure(SPE_RUNTIME_ERROR, SPE_SPU_INVALID_CHANNEL, SPE_SPU_INVALID_CHANNEL, EFAULT);
    case Cause::kOnlySoftcell:
      break;
  }
  return failure(SPE_RUNTIME_FATAL, EFAULT, -1, EFAULT);
}

Outcome outcome_of(const RunResult& result) {
  if (result.fault) return outcome_of(*result.fault);
  Outcome outcome;
  outcome.info.spu_status = static_cast<int>(result.stop_code << kStatusCodeShift) | kStatusStopped;
  if (result.ended_normally()) {
    outcome.info.stop_reason = SPE_EXIT;
    outcome.info.result.spe_exit_code = static_cast<int>(result.status());
  } else {
    outcome.info.stop_reason = SPE_STOP_AND_SIGNAL;
    outcome.info.result.spe_signal_code = static_cast<int>(result.stop_code);
    outcome.result = static_cast<int>(result.stop_code);
  }
  return outcome;
}

EntryArguments arguments_of(spe_context_ptr_t spe, unsigned int flags, void* argp, void* envp) {
  if ((flags & SPE_RUN_USER_REGS) == 0) {
    return {.spe_id = reinterpret_cast<std::uint64_t>(spe),
            .argp = reinterpret_cast<std::uint64_t>(argp),
            .envp = reinterpret_cast<std::uint64_t>(envp)};
  }
  std::array<std::uint64_t, 6> registers;  // three quadwords; an argument is the first half of its own
  std::memcpy(registers.data(), argp, sizeof registers);
  EntryArguments arguments{.spe_id = registers[0], .argp = registers[2], .envp = registers[4]};
  std::memcpy(arguments.registers.emplace().data(), argp, sizeof registers);
  return arguments;
}

void complain_of_call(std::uint32_t callnum) {
  // Calls of the C library do not come here if the word behind the stop names one.
  const bool is_of_library = callnum < softcell::libspe2::kLibraries;
  Machine::complain("an SPE program calls the PPU side by number " + std::to_string(callnum) +
                    (is_of_library
                         ? ", which is the C library's, and names no function that softcell has"
                         : ", for which spe_callback_handler_register() has registered no handler"));
}

/// Serves the calls of the PPU side by which the program stops.
/// @return  the first stop that is no call, or the failure of a call.
Outcome answer_calls(spe_context& context, ContextStop& stop, bool callbacks) {
  for (;;) {
    const std::uint32_t code = stop.result.stop_code;
    const bool asks = stop.goes_on && (code & ~kCallnumMask) == kAssistedCalls;
    if (!asks || !callbacks) return outcome_of(stop.result);
    const std::uint32_t callnum = code & kCallnumMask;
    auto* const callback = softcell::libspe2::callback_of(callnum);
    if (callback == nullptr) complain_of_call(callnum);
    const int result = callback == nullptr
                           ? kNoHandler
                           : callback(context.problem_state().local_store().data(), stop.assist.value);
    if (result != 0) {
      return failure(SPE_CALLBACK_ERROR, result, static_cast<int>(code << kStatusCodeShift) | kStatusStopped,
                     EFAULT);
    }
    Machine::get().stay_if_ending();
    stop = context.spe->resume();
  }
}

/// @return  nothing: there is no such entry.
std::optional<ContextStop> begin_or_go_on(spe_context& context, unsigned int entry,
                                          const EntryArguments& arguments) {
  bool goes_on = false;
  {
    const std::lock_guard lock(context.mutex);
    goes_on = context.goes_on && entry == context.next_entry;
    if (!goes_on && entry != SPE_DEFAULT_ENTRY && entry != context.image->entry) return std::nullopt;
    context.goes_on = false;
  }
  Machine::get().count_run();
  return goes_on ? context.spe->resume() : context.spe->run(arguments);
}

struct RunEnd {
  RunEnd() = default;
  ~RunEnd() { Machine::get().end_run(); }
  RunEnd(const RunEnd&) = delete;
  RunEnd& operator=(const RunEnd&) = delete;
};

int run(spe_context_ptr_t spe, spe_context& context, unsigned int* entry, unsigned int flags, void* argp,
        void* envp, spe_stop_info_t* stopinfo) {
  {
    const std::lock_guard lock(context.mutex);
    if (context.image == nullptr) return fail(ENOEXEC);
  }
  Machine::get().stay_if_ending();
  std::optional<ContextStop> stop;
  try {
    stop = begin_or_go_on(context, *entry, arguments_of(spe, flags, argp, envp));
  } catch (const std::runtime_error& error) {
    Machine::complain(error.what());
    Machine::get().uncount_run();
    return fail(EAGAIN);
  }
  if (!stop) return fail(EINVAL);
  const Outcome outcome = [&] {
    const RunEnd end;  // also when the handler of a callback throws
    Outcome answered = answer_calls(context, *stop, (flags & SPE_NO_CALLBACKS) == 0);
    Machine::get().stay_if_ending();
    if (stop->result.fault) Machine::get().report(*stop->result.fault);
    return answered;
  }();
  *entry = stop->next.value;
  {
    const std::lock_guard lock(context.mutex);
    context.goes_on = stop->goes_on;
    // A command that the MFC refuses does not stop the SPU, so its status is that of a running one.
    context.registers.spu_status =
        outcome.info.spu_status < 0 ? 0 : static_cast<std::uint32_t>(outcome.info.spu_status);
    context.next_entry = stop->next.value;
    if ((context.flags & SPE_EVENTS_ENABLE) != 0) {
      if (context.stops.size() == kMostStops) context.stops.pop_front();
      context.stops.push_back(outcome.info);
      context.has_stop = true;
    }
  }
  Machine::get().contexts().wake();
  if (stopinfo != nullptr) *stopinfo = outcome.info;
  if (outcome.error != 0) errno = outcome.error;
  return outcome.result;
}

}  // namespace

int spe_context_run(spe_context_ptr_t spe, unsigned int* entry, unsigned int runflags, void* argp, void* envp,
                    spe_stop_info_t* stopinfo) {
  const auto work = [&](spe_context& context) {
    if (entry == nullptr || (runflags & ~kRunFlags) != 0) return fail(EINVAL);
    if ((runflags & SPE_RUN_USER_REGS) != 0 && argp == nullptr) return fail(EINVAL);
    if (context.busy.exchange(true)) return fail(EBUSY);
    struct Release {
      std::atomic<bool>& busy;
      ~Release() { busy = false; }
    };
    const Release release{context.busy};
    return run(spe, context, entry, runflags, argp, envp, stopinfo);
  };
  return with_context(spe, work, Waits::kForARun);
}

int spe_stop_info_read(spe_context_ptr_t spe, spe_stop_info_t* stopinfo) {
  return with_context(spe, [&](spe_context& context) {
    if (stopinfo == nullptr) return fail(EINVAL);
    if ((context.flags & SPE_EVENTS_ENABLE) == 0) return fail(ENOTSUP);
    const std::lock_guard lock(context.mutex);
    if (context.stops.empty()) return fail(EAGAIN);
    *stopinfo = context.stops.front();
    context.stops.pop_front();
    context.has_stop = !context.stops.empty();
    return 0;
  });
}
