#include "cancellable_wait.h"

#include <pthread.h>

#include <ctime>
#include <utility>

#include "softcell/ls_sim/cancellation.h"

namespace softcell::ls_sim {
namespace {

thread_local bool is_allowed_here = false;

/// While the object lives, the thread may be cancelled at cancellation points.
class Cancellable {
 public:
  Cancellable() { pthread_setcancelstate(PTHREAD_CANCEL_ENABLE, &before_); }
  ~Cancellable() { pthread_setcancelstate(before_, nullptr); }
  Cancellable(const Cancellable&) = delete;
  Cancellable& operator=(const Cancellable&) = delete;

 private:
  int before_ = 0;
};

}  // namespace

MayBeCancelled::MayBeCancelled() : before_(std::exchange(is_allowed_here, true)) {}
MayBeCancelled::~MayBeCancelled() { is_allowed_here = before_; }
bool MayBeCancelled::is_allowed() { return is_allowed_here; }

void wait_once(std::condition_variable& condition, std::unique_lock<std::mutex>& lock,
               std::optional<std::chrono::steady_clock::time_point> until) {
  if (!MayBeCancelled::is_allowed()) {
    if (until) {
      condition.wait_until(lock, *until);
    } else {
      condition.wait(lock);
    }
    return;
  }
  const Cancellable here;
  pthread_mutex_t* const mutex = lock.mutex()->native_handle();
  if (!until) {
    pthread_cond_wait(condition.native_handle(), mutex);
    return;
  }
  using namespace std::chrono;
  const auto since_boot = until->time_since_epoch();
  const timespec time{.tv_sec = duration_cast<seconds>(since_boot).count(),
                      .tv_nsec = (nanoseconds(since_boot) % seconds(1)).count()};
  pthread_cond_clockwait(condition.native_handle(), mutex, CLOCK_MONOTONIC, &time);
}

}  // namespace softcell::ls_sim
