// Raw SPUs: the program itself loads and starts them, and reads their registers.

#include <chrono>
#include <cstring>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "images.h"
#include "lv2.h"
#include "ppu/libspe2/object.h"
#include "ppu/libspe2/programs.h"
#include "ppu/libspe2/registers.h"
#include "softcell/base/text.h"

using namespace softcell::psl1ght;

namespace {

using softcell::dma::Rule;
using softcell::libspe2::Objects;
using softcell::ls_sim::ContextStop;

constexpr u32 kClasses = 3, kClassOfMailboxes = 2;
constexpr u64 kMailboxInterrupt = 1, kStopInterrupt = 2, kHaltInterrupt = 4;
// SPU_Status [CBEA] documented
constexpr u32 kRunning = 1, kStopped = 2, kHalted = 4, kIllegalInstruction = 0x20, kIllegalChannel = 0x40,
              kCodeShift = 16;

/// Why the SPU has stopped by itself; 0: something else has stopped it.
u32 status_of(const softcell::ls_sim::RunResult& result) {
  if (!result.fault) return result.stop_code << kCodeShift | kStopped;
  switch (result.fault->rule) {
    case Rule::kKernelHalt:
      return kHalted;
    case Rule::kIllegalInstruction:
      return kIllegalInstruction;
    case Rule::kIllegalChannel:
      return kIllegalChannel;
    default:
      return 0;
  }
}

/// @return  null: there is none with that number
std::shared_ptr<RawSpu> find(u32 number) {
  Lv2& lv2 = Lv2::get();
  const std::lock_guard lock(lv2.mutex);
  const auto found = lv2.raw_spus.find(number);
  return found == lv2.raw_spus.end() ? nullptr : found->second;
}

template <class Work>
s32 with_spu(u32 number, Work&& work) {
  return call([&]() -> std::uint32_t {
    const auto spu = find(number);
    return spu == nullptr ? static_cast<std::uint32_t>(kNoSuchObject) : work(*spu);
  });
}

/// On a host thread of its own: from its start to its next stop.
void run(RawSpu& spu, bool goes_on) {
  Lv2& lv2 = Lv2::get();
  ContextStop stop;
  try {
    stop = goes_on ? spu.context->spe->resume() : spu.context->spe->run({});
  } catch (const std::exception& error) {
    Machine::complain(error.what());
  }
  Machine::get().stay_if_ending();
  const u32 status = status_of(stop.result);
  bool told_to = false;
  {
    const std::lock_guard lock(lv2.mutex);
    told_to = std::exchange(spu.stopping, false);
    spu.status = status;
    spu.goes_on = stop.goes_on;
    spu.next_pc = stop.next.value;
    spu.runs = false;
    lv2.changed.notify_all();
  }
  // lv2 has no exceptions of raw SPUs: the program finds the SPU's own in its status.
  if (stop.result.fault && !told_to) report_fault(*stop.result.fault, status != 0);
}

void start(RawSpu& spu) {
  Lv2& lv2 = Lv2::get();
  std::unique_lock lock(lv2.mutex);
  if (spu.runs) return;
  if (spu.context->image == nullptr) {
    Machine::complain("a raw SPU is started, and nothing was loaded into it");
    return;
  }
  spu.runs = true;
  spu.status = kRunning;
  const bool goes_on = std::exchange(spu.goes_on, false);
  lock.unlock();
  Machine::get().count_run();
  spu.host = std::jthread([&spu, goes_on] { run(spu, goes_on); });  // joins the last
}

void stop(RawSpu& spu) {
  Lv2& lv2 = Lv2::get();
  std::unique_lock lock(lv2.mutex);
  spu.stopping = spu.runs;
  while (spu.runs) {
    spu.context->spe->interrupt();  // again: it was perhaps about to start
    lv2.changed.wait_for(lock, std::chrono::milliseconds(1));
  }
}

u32 load_program(RawSpu& spu, std::shared_ptr<const softcell::ls_sim::KernelImage> program) {
  {
    const std::lock_guard lock(Lv2::get().mutex);
    if (spu.runs) return kBusy;
    spu.goes_on = false;
    spu.next_pc = program->entry;
  }
  spu.context->spe->load(program);
  const std::lock_guard lock(spu.context->mutex);
  spu.context->image = std::move(program);
  return kOk;
}

}  // namespace

s32 sysSpuRawCreate(sys_raw_spu_t* spu, u32*) {
  return call([&]() -> std::uint32_t {
    if (spu == nullptr) return kFault;
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    if (lv2.raw_spus.size() >= lv2.raw_room) return kAgain;
    auto made = std::make_shared<RawSpu>();
    made->context = std::make_shared<spe_context>(SPE_MAP_PS);
    made->context->spe = Machine::get().contexts().create();
    if (made->context->spe == nullptr) return kAgain;
    Machine::get().count_context();
    Objects<spe_context>::all().add(made->context);
    *spu = static_cast<u32>(made->context->spe->number());
    lv2.raw_spus.emplace(*spu, std::move(made));
    return kOk;
  });
}

s32 sysSpuRawDestroy(sys_raw_spu_t number) {
  return call([&]() -> std::uint32_t {
    const auto spu = find(number);
    if (spu == nullptr) return kNoSuchObject;
    stop(*spu);
    if (spu->host.joinable()) spu->host.join();
    Objects<spe_context>::all().remove(spu->context.get());
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    lv2.raw_spus.erase(number);
    return kOk;
  });
}

s32 sysSpuRawImageLoad(sys_raw_spu_t number, sysSpuImage* image) {
  return with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    if (image == nullptr) return kFault;
    auto program = program_of(image);
    return program == nullptr ? static_cast<std::uint32_t>(kInvalid) : load_program(spu, std::move(program));
  });
}

s32 sysSpuRawLoad(sys_raw_spu_t number, const char* path, u32* entry) {
  return with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    if (path == nullptr || entry == nullptr) return kFault;
    sysSpuImage image;
    if (const s32 error = sysSpuImageOpen(&image, path); error != 0) return static_cast<std::uint32_t>(error);
    *entry = image.entryPoint;
    const u32 error = load_program(spu, program_of(&image));
    sysSpuImageClose(&image);
    return error;
  });
}

s32 sysSpuRawCreateInterrupTag(sys_raw_spu_t number, u32, u32, u32*) {
  return with_spu(number, [](RawSpu&) {
    return refuse("sysSpuRawCreateInterrupTag",
                  "a PC program has no interrupt handlers for SPUs; read the status and the mailboxes");
  });
}

s32 sysSpuRawSetIntMask(sys_raw_spu_t number, u32 classid, u64 mask) {
  return with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    if (classid >= kClasses) return kInvalid;
    spu.masks[classid] = mask;
    return kOk;
  });
}

s32 sysSpuRawGetIntMask(sys_raw_spu_t number, u32 classid, u64* mask) {
  return with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    if (classid >= kClasses) return kInvalid;
    if (mask == nullptr) return kFault;
    *mask = spu.masks[classid];
    return kOk;
  });
}

s32 sysSpuRawSetIntStat(sys_raw_spu_t number, u32 classid, u64) {
  return with_spu(number, [&](RawSpu&) -> std::uint32_t { return classid >= kClasses ? kInvalid : kOk; });
}

s32 sysSpuRawGetIntStat(sys_raw_spu_t number, u32 classid, u64* stat) {
  return with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    if (classid >= kClasses) return kInvalid;
    if (stat == nullptr) return kFault;
    *stat = 0;
    if (classid != kClassOfMailboxes) return kOk;
    if (spu.context->spe->state().out_intr_mbox != 0) *stat |= kMailboxInterrupt;
    const std::lock_guard lock(Lv2::get().mutex);
    if ((spu.status & kStopped) != 0) *stat |= kStopInterrupt;
    if ((spu.status & kHalted) != 0) *stat |= kHaltInterrupt;
    return kOk;
  });
}

s32 sysSpuRawReadPuintMb(sys_raw_spu_t number, u32* value) {
  return with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    if (value == nullptr) return kFault;
    const auto read = spu.context->problem_state().read_out_intr_mbox();
    if (!read) return kBusy;
    *value = *read;
    return kOk;
  });
}

s32 sysSpuRawSetConfiguration(sys_raw_spu_t number, u32 value) {
  return with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    using softcell::ls_sim::SignalMode;
    if ((value & ~kSignalModes) != 0) return kInvalid;
    spu.signal_mode = value;
    const auto mode = [&](u32 bit) { return (value & bit) != 0 ? SignalMode::kOr : SignalMode::kOverwrite; };
    spu.context->problem_state().set_signal_mode(1, mode(SPU_SIGNAL1_OR));
    spu.context->problem_state().set_signal_mode(2, mode(SPU_SIGNAL2_OR));
    return kOk;
  });
}

s32 sysSpuRawGetConfirugation(sys_raw_spu_t number, u32* value) {
  return with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    if (value == nullptr) return kFault;
    *value = spu.signal_mode;
    return kOk;
  });
}

s32 sysSpuRawRecoverPageFault(sys_raw_spu_t number) {
  return with_spu(number,
                  [](RawSpu&) { return refuse("sysSpuRawRecoverPageFault", "a fault ends the program"); });
}

void sysSpuRawWriteProblemStorage(sys_raw_spu_t number, u32 reg, u32 value) {
  call([&]() -> std::uint32_t {
    const auto spu = find(number);
    if (spu == nullptr) {
      Machine::complain("the program writes to a register of raw SPU " + std::to_string(number) +
                        ", which does not exist");
      return kNoSuchObject;
    }
    switch (reg) {
      case SPU_RunCtrl:
        if ((value & 1) != 0) {
          start(*spu);
        } else {
          stop(*spu);
        }
        return kOk;
      case SPU_NextPC: {
        const std::lock_guard lock(Lv2::get().mutex);
        const u32 pc = value & ~3u;
        if (pc != spu->next_pc) {
          Machine::complain("a raw SPU is to begin at " + softcell::base::hex(pc) +
                            "; softcell begins a program at its entry " + softcell::base::hex(spu->next_pc));
        }
        return kOk;
      }
      default:
        softcell::libspe2::access_register(*spu->context, SPU_PROBLEM_OFFSET + reg, true, value);
        return kOk;
    }
  });
}

u32 sysSpuRawReadProblemStorage(sys_raw_spu_t number, u32 reg) {
  u32 value = 0;
  call([&]() -> std::uint32_t {
    const auto spu = find(number);
    if (spu == nullptr) {
      Machine::complain("the program reads a register of raw SPU " + std::to_string(number) +
                        ", which does not exist");
      return kNoSuchObject;
    }
    Lv2& lv2 = Lv2::get();
    switch (reg) {
      case SPU_RunCtrl:
      case SPU_Status: {
        const std::lock_guard lock(lv2.mutex);
        value = reg == SPU_Status ? spu->status : (spu->runs ? 1 : 0);
        return kOk;
      }
      case SPU_NextPC: {
        const std::lock_guard lock(lv2.mutex);
        value = spu->next_pc;
        return kOk;
      }
      default:
        softcell::libspe2::access_register(*spu->context, SPU_PROBLEM_OFFSET + reg, false, value);
        return kOk;
    }
  });
  return value;
}

void sysSpuRawWriteLocalStorage(sys_raw_spu_t number, u32 reg, u32 value) {
  with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    spu.context->problem_state().write_local_store({reg}, std::as_bytes(std::span(&value, 1)));
    return kOk;
  });
}

u32 sysSpuRawReadLocalStorage(sys_raw_spu_t number, u32 reg) {
  u32 value = 0;
  with_spu(number, [&](RawSpu& spu) -> std::uint32_t {
    const auto bytes = spu.context->problem_state().local_store();
    if (reg > bytes.size() - sizeof value) return kInvalid;
    std::memcpy(&value, &bytes[reg], sizeof value);
    return kOk;
  });
  return value;
}
