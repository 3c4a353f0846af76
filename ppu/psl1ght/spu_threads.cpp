// SPU threads as the program sets them up and talks to them.

#include <array>
#include <cstring>
#include <memory>
#include <mutex>
#include <span>

#include "group_run.h"
#include "images.h"
#include "lv2.h"

using namespace softcell::psl1ght;
using softcell::ls_sim::EntryArguments;

namespace {

/// work(group, thread) of a thread that there is, with the lock.
template <class Work>
s32 with_thread(u32 number, Work&& work) {
  return call([&]() -> std::uint32_t {
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    const auto found = lv2.threads.find(number);
    return found == lv2.threads.end() ? static_cast<std::uint32_t>(kNoSuchObject)
                                      : work(*found->second.first, *found->second.second);
  });
}

/// Does the same with a thread whose group runs.
template <class Work>
s32 with_running_thread(u32 number, Work&& work) {
  return with_thread(number, [&](Group& group, SpuThread& thread) -> std::uint32_t {
    return group.runs ? work(thread) : static_cast<std::uint32_t>(kWrongState);
  });
}

EntryArguments arguments_of(const sysSpuThreadArgument& given) {
  return {.spe_id = given.arg0,
          .argp = given.arg1,
          .envp = given.arg2,
          .fourth = given.arg3,
          .entry_state = softcell::ls_sim::EntryState::kThreadGroup};
}

bool is_place(u32 address, u32 bytes) {
  return (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8) && address % bytes == 0 &&
         address <= softcell::dma::kLocalStoreBytes - bytes;
}

}  // namespace

s32 sysSpuThreadInitialize(sys_spu_thread_t* thread, sys_spu_group_t number, u32 spu, sysSpuImage* image,
                           sysSpuThreadAttribute* attributes, sysSpuThreadArgument* arguments) {
  return call([&]() -> std::uint32_t {
    if (thread == nullptr || image == nullptr || attributes == nullptr || arguments == nullptr) return kFault;
    const auto program = program_of(image);
    if (program == nullptr) return kInvalid;
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    const auto group = lv2.group(number);
    if (group == nullptr) return kNoSuchObject;
    if (spu >= group->threads.size()) return kInvalid;
    if (group->runs || group->threads[spu] != nullptr) return kBusy;
    auto made = std::make_unique<SpuThread>();
    made->number = ++lv2.last_number;
    made->index = spu;
    made->image = program;
    made->arguments = arguments_of(*arguments);
    *thread = made->number;
    lv2.threads.emplace(made->number, std::pair(group, made.get()));
    group->threads[spu] = std::move(made);
    return kOk;
  });
}

s32 sysSpuThreadSetArguments(sys_spu_thread_t number, sysSpuThreadArgument* arguments) {
  return with_thread(number, [&](Group& group, SpuThread& thread) -> std::uint32_t {
    if (arguments == nullptr) return kFault;
    if (group.runs) return kBusy;
    thread.arguments = arguments_of(*arguments);
    return kOk;
  });
}

s32 sysSpuThreadGetExitStatus(sys_spu_thread_t number, s32* status) {
  return with_thread(number, [&](Group&, SpuThread& thread) -> std::uint32_t {
    if (status == nullptr) return kFault;
    if (!thread.exit_status) return kWrongState;
    *status = *thread.exit_status;
    return kOk;
  });
}

s32 sysSpuThreadConnectEvent(sys_spu_thread_t number, sys_event_queue_t queue, u32 type, u8 spup) {
  return with_thread(number, [&](Group&, SpuThread& thread) -> std::uint32_t {
    if (type != SPU_THREAD_EVENT_USER || spup >= kPorts) return kInvalid;
    auto found = Lv2::get().queue(queue);
    if (found == nullptr) return kNoSuchObject;
    return thread.ports.emplace(spup, std::move(found)).second ? kOk : kConnected;
  });
}

s32 sysSpuThreadDisconnectEvent(sys_spu_thread_t number, u32 type, u8 spup) {
  return with_thread(number, [&](Group&, SpuThread& thread) -> std::uint32_t {
    if (type != SPU_THREAD_EVENT_USER || spup >= kPorts) return kInvalid;
    return thread.ports.erase(spup) == 0 ? kNotConnected : kOk;
  });
}

s32 sysSpuThreadBindQueue(sys_spu_thread_t number, sys_event_queue_t queue, u32 spuq_num) {
  return with_thread(number, [&](Group&, SpuThread& thread) -> std::uint32_t {
    auto found = Lv2::get().queue(queue);
    if (found == nullptr) return kNoSuchObject;
    if (found->type != SYS_EVENT_QUEUE_SPU) return kInvalid;
    return thread.queues.emplace(spuq_num, std::move(found)).second ? kOk : kBusy;
  });
}

s32 sysSpuThreadUnbindQueue(sys_spu_thread_t number, u32 spuq_num) {
  return with_thread(number, [&](Group&, SpuThread& thread) -> std::uint32_t {
    return thread.queues.erase(spuq_num) == 0 ? kNoSuchObject : kOk;
  });
}

s32 sysSpuThreadWriteLocalStorage(sys_spu_thread_t number, u32 address, u64 value, u32 type) {
  return with_running_thread(number, [&](SpuThread& thread) -> std::uint32_t {
    if (!is_place(address, type)) return kInvalid;
    std::array<std::byte, sizeof value> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    thread.context->problem_state().write_local_store({address}, std::span(bytes).first(type));
    return kOk;
  });
}

s32 sysSpuThreadReadLocalStorage(sys_spu_thread_t number, u32 address, u64* value, u32 type) {
  return with_running_thread(number, [&](SpuThread& thread) -> std::uint32_t {
    if (value == nullptr) return kFault;
    if (!is_place(address, type)) return kInvalid;
    *value = 0;
    std::memcpy(value, &thread.context->problem_state().local_store()[address], type);
    return kOk;
  });
}

s32 sysSpuThreadWriteSignal(sys_spu_thread_t number, u32 signal, u32 value) {
  return with_running_thread(number, [&](SpuThread& thread) -> std::uint32_t {
    if (signal > 1) return kInvalid;
    thread.context->problem_state().write_signal(static_cast<int>(signal) + 1, value);
    return kOk;
  });
}

s32 sysSpuThreadSetConfiguration(sys_spu_thread_t number, u64 value) {
  return with_thread(number, [&](Group&, SpuThread& thread) -> std::uint32_t {
    if ((value & ~kSignalModes) != 0) return kInvalid;
    thread.configuration = value;
    if (thread.context != nullptr) configure_signals(thread);
    return kOk;
  });
}

s32 sysSpuThreadGetConfiguration(sys_spu_thread_t number, u64* value) {
  return with_thread(number, [&](Group&, SpuThread& thread) -> std::uint32_t {
    if (value == nullptr) return kFault;
    *value = thread.configuration;
    return kOk;
  });
}

s32 sysSpuThreadWriteMb(sys_spu_thread_t number, u32 value) {
  return with_running_thread(number, [&](SpuThread& thread) -> std::uint32_t {
    thread.context->problem_state().write_in_mbox(value);
    return kOk;
  });
}

s32 sysSpuThreadRecoverPageFault(sys_spu_thread_t number) {
  return with_thread(number, [](Group&, SpuThread&) {
    return refuse("sysSpuThreadRecoverPageFault", "a fault ends the thread");
  });
}
