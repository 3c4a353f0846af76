#include "callbacks.h"

#include <array>
#include <atomic>
#include <cerrno>

#include "libspe2.h"
#include "object.h"

namespace softcell::libspe2 {
namespace {

constexpr unsigned int kCallbacks = 256;

std::atomic<void*>& slot(unsigned int callnum) {
  static std::array<std::atomic<void*>, kCallbacks> slots{};
  return slots[callnum];
}

}  // namespace

Callback* callback_of(unsigned int callnum) {
  if (callnum >= kCallbacks) return nullptr;
  return reinterpret_cast<Callback*>(slot(callnum).load(std::memory_order_acquire));
}

}  // namespace softcell::libspe2

using namespace softcell::libspe2;

int spe_callback_handler_register(void* handler, unsigned int callnum, unsigned int mode) {
  if (handler == nullptr || callnum >= kCallbacks) return fail(EINVAL);
  void* before = nullptr;
  switch (mode) {
    case SPE_CALLBACK_NEW:
      if (callnum < kLibraries) return fail(EACCES);
      return slot(callnum).compare_exchange_strong(before, handler) ? 0 : fail(EACCES);
    case SPE_CALLBACK_UPDATE:
      if (callnum < kLibraries) return fail(EACCES);
      before = slot(callnum).load();
      while (before != nullptr && !slot(callnum).compare_exchange_weak(before, handler)) {
      }
      return before != nullptr ? 0 : fail(ESRCH);
    default:
      return fail(EINVAL);
  }
}

int spe_callback_handler_deregister(unsigned int callnum) {
  if (callnum >= kCallbacks) return fail(EINVAL);
  if (callnum < kLibraries) return fail(EACCES);
  return slot(callnum).exchange(nullptr) != nullptr ? 0 : fail(ESRCH);
}

void* spe_callback_handler_query(unsigned int callnum) {
  if (callnum >= kCallbacks) {
    errno = EINVAL;
    return nullptr;
  }
  void* const handler = slot(callnum).load();
  if (handler == nullptr) errno = ESRCH;
  return handler;
}
