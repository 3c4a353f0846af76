// Thread groups as the program makes, starts and joins them.

#include "group_run.h"

#include <memory>
#include <mutex>
#include "lv2.h"

using namespace softcell::psl1ght;

namespace {

constexpr u32 kHighestPriority = 16, kLowestPriority = 255;

bool is_priority(u32 priority) { return priority >= kHighestPriority && priority <= kLowestPriority; }

/// work(lock, group) of a group that there is.
template <class Work>
s32 with_group(u32 number, Work&& work) {
  return call([&]() -> std::uint32_t {
    Lv2& lv2 = Lv2::get();
    std::unique_lock lock(lv2.mutex);
    const auto group = lv2.group(number);
    return group == nullptr ? static_cast<std::uint32_t>(kNoSuchObject) : work(lock, group);
  });
}

/// The queue that events of a type go to; null: there is no such type.
std::shared_ptr<Queue>* events_of(Group& group, u32 type) {
  if (type == SPU_THREAD_GROUP_EVENT_RUN) return &group.run_events;
  return type == SPU_THREAD_GROUP_EVENT_EXCEPTION ? &group.exception_events : nullptr;
}

}  // namespace

s32 sysSpuInitialize(u32 spus, u32 rawspus) {
  return call([&]() -> std::uint32_t {
    if (spus > kMostSpus || rawspus > spus || rawspus == kMostSpus) return kInvalid;
    Machine::get();
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    lv2.raw_room = rawspus;
    return kOk;
  });
}

s32 sysSpuThreadGroupCreate(sys_spu_group_t* group, u32 num, u32 prio, sysSpuThreadGroupAttribute* attr) {
  return call([&]() -> std::uint32_t {
    if (group == nullptr || attr == nullptr) return kFault;
    if (num < 1 || num > kMostSpus || !is_priority(prio)) return kInvalid;
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    auto made = std::make_shared<Group>();
    made->number = ++lv2.last_number;
    made->priority = prio;
    made->threads.resize(num);
    *group = made->number;
    lv2.groups.emplace(made->number, std::move(made));
    return kOk;
  });
}

s32 sysSpuThreadGroupDestroy(sys_spu_group_t number) {
  return with_group(
      number, [&](std::unique_lock<std::mutex>& lock, const std::shared_ptr<Group>& group) -> std::uint32_t {
        if (group->runs) return kBusy;
        Lv2& lv2 = Lv2::get();
        lv2.groups.erase(number);
        for (const auto& thread : group->threads) {
          if (thread != nullptr) lv2.threads.erase(thread->number);
        }
        lock.unlock();
        // Here, so that the last of these threads does not destroy the group that it belongs to.
        if (group->service.joinable()) group->service.join();
        for (const auto& thread : group->threads) {
          if (thread != nullptr && thread->host.joinable()) thread->host.join();
        }
        return kOk;
      });
}

s32 sysSpuThreadGroupStart(sys_spu_group_t number) {
  return with_group(number, [](std::unique_lock<std::mutex>& lock, const std::shared_ptr<Group>& group) {
    return start_group(lock, group);
  });
}

s32 sysSpuThreadGroupJoin(sys_spu_group_t number, u32* cause, u32* status) {
  return with_group(
      number, [&](std::unique_lock<std::mutex>& lock, const std::shared_ptr<Group>& group) -> std::uint32_t {
        if (!group->runs && !group->end) return kWrongState;
        if (group->joined) return kBusy;
        group->joined = true;
        Lv2::get().changed.wait(lock, [&] { return !group->runs; });
        group->joined = false;
        if (cause != nullptr) *cause = group->end->cause;
        if (status != nullptr) *status = group->end->status;
        group->end.reset();
        return kOk;
      });
}

s32 sysSpuThreadGroupTerminate(sys_spu_group_t number, u32 value) {
  return with_group(number,
                    [&](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>& group) -> std::uint32_t {
                      if (!group->runs) return kWrongState;
                      end_group(*group, {SPU_THREAD_GROUP_JOIN_TERMINATED, value});
                      return kOk;
                    });
}

s32 sysSpuThreadGroupYield(sys_spu_group_t number) {
  return with_group(number,
                    [](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>& group) -> std::uint32_t {
                      return group->runs ? kOk : kWrongState;
                    });
}

s32 sysSpuThreadGroupSuspend(sys_spu_group_t number) {
  return with_group(number, [](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>&) {
    return refuse("sysSpuThreadGroupSuspend", "an SPE of softcell is not stopped between its instructions");
  });
}

s32 sysSpuThreadGroupResume(sys_spu_group_t number) {
  return with_group(number, [](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>&) {
    return refuse("sysSpuThreadGroupResume", "softcell suspends no thread group");
  });
}

s32 sysSpuThreadGroupSetPriority(sys_spu_group_t number, u32 prio) {
  return with_group(number,
                    [&](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>& group) -> std::uint32_t {
                      if (!is_priority(prio)) return kInvalid;
                      group->priority = prio;
                      return kOk;
                    });
}

s32 sysSpuThreadGroupGetPriority(sys_spu_group_t number, u32* prio) {
  return with_group(number,
                    [&](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>& group) -> std::uint32_t {
                      if (prio == nullptr) return kFault;
                      *prio = group->priority;
                      return kOk;
                    });
}

s32 sysSpuThreadGroupConnectEvent(sys_spu_group_t number, sys_event_queue_t eventQ, u32 eventType) {
  return with_group(number,
                    [&](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>& group) -> std::uint32_t {
                      std::shared_ptr<Queue>* const events = events_of(*group, eventType);
                      if (events == nullptr) return kInvalid;
                      if (*events != nullptr) return kConnected;
                      *events = Lv2::get().queue(eventQ);
                      return *events == nullptr ? kNoSuchObject : kOk;
                    });
}

s32 sysSpuThreadGroupDisconnectEvent(sys_spu_group_t number, u32 eventType) {
  return with_group(number,
                    [&](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>& group) -> std::uint32_t {
                      std::shared_ptr<Queue>* const events = events_of(*group, eventType);
                      if (events == nullptr) return kInvalid;
                      if (*events == nullptr) return kNotConnected;
                      *events = nullptr;
                      return kOk;
                    });
}

s32 sysSpuThreadGroupConnectEventAllThreads(sys_spu_group_t number, sys_event_queue_t eventQ, u64 req,
                                            u8* spup) {
  return with_group(number,
                    [&](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>& group) -> std::uint32_t {
                      if (spup == nullptr) return kFault;
                      if (req == 0) return kInvalid;
                      const auto queue = Lv2::get().queue(eventQ);
                      if (queue == nullptr) return kNoSuchObject;
                      u64 free = req;
                      for (const auto& thread : group->threads) {
                        if (thread == nullptr) return kWrongState;
                        for (const auto& [port, connected] : thread->ports) free &= ~(u64{1} << port);
                      }
                      if (free == 0) return kConnected;
                      *spup = static_cast<u8>(__builtin_ctzll(free));
                      for (const auto& thread : group->threads) thread->ports.emplace(*spup, queue);
                      return kOk;
                    });
}

s32 sysSpuThreadGroupDisonnectEventAllThreads(sys_spu_group_t number, u8 spup) {
  return with_group(number,
                    [&](std::unique_lock<std::mutex>&, const std::shared_ptr<Group>& group) -> std::uint32_t {
                      if (spup >= kPorts) return kInvalid;
                      for (const auto& thread : group->threads) {
                        if (thread != nullptr) thread->ports.erase(spup);
                      }
                      return kOk;
                    });
}
