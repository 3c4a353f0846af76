// Event queues and ports.

#include "lv2.h"

#include <memory>
#include <mutex>

using namespace softcell::psl1ght;

namespace {

constexpr s32 kMostEvents = 127;
constexpr std::uint64_t kPortSource = 32;  // the process's number stands above a port's own

/// work(port) of a port that there is, with the lock.
template <class Work>
s32 with_port(u32 number, Work&& work) {
  return call([&]() -> std::uint32_t {
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    const auto found = lv2.ports.find(number);
    return found == lv2.ports.end() ? static_cast<std::uint32_t>(kNoSuchObject) : work(found->second);
  });
}

}  // namespace

s32 sysEventQueueCreate(sys_event_queue_t* eventQ, sys_event_queue_attr_t* attrib, sys_ipc_key_t key,
                        s32 size) {
  return call([&]() -> std::uint32_t {
    if (eventQ == nullptr || attrib == nullptr) return kFault;
    if (size < 1 || size > kMostEvents) return kInvalid;
    if (attrib->type != SYS_EVENT_QUEUE_PPU && attrib->type != SYS_EVENT_QUEUE_SPU) return kInvalid;
    if (attrib->attr_protocol < SYS_EVENT_QUEUE_FIFO || attrib->attr_protocol > SYS_EVENT_QUEUE_PRIO_INHERIT)
      return kInvalid;
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    for (const auto& [number, queue] : lv2.queues) {
      if (key != SYS_EVENT_QUEUE_KEY_LOCAL && queue->key == key) return kExists;
    }
    *eventQ = ++lv2.last_number;
    lv2.queues.emplace(
        *eventQ,
        std::shared_ptr<Queue>(new Queue{
            .type = attrib->type, .key = key, .room = static_cast<std::size_t>(size), .events = {}}));
    return kOk;
  });
}

s32 sysEventQueueDestroy(sys_event_queue_t eventQ, s32 mode) {
  return call([&]() -> std::uint32_t {
    if (mode != 0 && mode != SYS_EVENT_QUEUE_FORCE_DESTROY) return kInvalid;
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    const auto queue = lv2.queue(eventQ);
    if (queue == nullptr) return kNoSuchObject;
    if (mode == 0 && queue->waiting != 0) return kBusy;
    queue->destroyed = true;
    queue->events.clear();
    lv2.queues.erase(eventQ);
    lv2.changed.notify_all();
    return kOk;
  });
}

s32 sysEventQueueReceive(sys_event_queue_t eventQ, sys_event_t* event, u64 timeout_usec) {
  return call([&]() -> std::uint32_t {
    if (event == nullptr) return kFault;
    Lv2& lv2 = Lv2::get();
    std::unique_lock lock(lv2.mutex);
    const auto queue = lv2.queue(eventQ);
    if (queue == nullptr) return kNoSuchObject;
    if (queue->type != SYS_EVENT_QUEUE_PPU) return kInvalid;
    return lv2.receive(lock, queue, *event, timeout_usec, [] { return false; });
  });
}

s32 sysEventQueueDrain(sys_event_queue_t eventQ) {
  return call([&]() -> std::uint32_t {
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    const auto queue = lv2.queue(eventQ);
    if (queue == nullptr) return kNoSuchObject;
    queue->events.clear();
    return kOk;
  });
}

s32 sysEventPortCreate(sys_event_port_t* portId, int portType, u64 name) {
  return call([&]() -> std::uint32_t {
    if (portId == nullptr) return kFault;
    if (portType != SYS_EVENT_PORT_LOCAL) return kInvalid;
    Lv2& lv2 = Lv2::get();
    const std::lock_guard lock(lv2.mutex);
    *portId = ++lv2.last_number;
    lv2.ports.emplace(*portId, Port{.number = *portId, .name = name, .queue = nullptr});
    return kOk;
  });
}

s32 sysEventPortDestroy(sys_event_port_t portId) {
  return with_port(portId, [&](Port& port) -> std::uint32_t {
    if (port.queue != nullptr) return kConnected;
    Lv2::get().ports.erase(portId);
    return kOk;
  });
}

s32 sysEventPortConnectLocal(sys_event_port_t portId, sys_event_queue_t eventQ) {
  return with_port(portId, [&](Port& port) -> std::uint32_t {
    if (port.queue != nullptr) return kConnected;
    port.queue = Lv2::get().queue(eventQ);
    return port.queue == nullptr ? kNoSuchObject : kOk;
  });
}

s32 sysEventPortDisconnect(sys_event_port_t portId) {
  return with_port(portId, [](Port& port) -> std::uint32_t {
    if (port.queue == nullptr) return kNotConnected;
    port.queue = nullptr;
    return kOk;
  });
}

s32 sysEventPortSend(sys_event_port_t portId, u64 data0, u64 data1, u64 data2) {
  return with_port(portId, [&](Port& port) -> std::uint32_t {
    if (port.queue == nullptr || port.queue->destroyed) return kNotConnected;
    const u64 source = port.name != SYS_EVENT_PORT_NO_NAME ? port.name : u64{1} << kPortSource | port.number;
    return Lv2::get().send(*port.queue, {source, data0, data1, data2});
  });
}
