#pragma once
// The objects that the program holds by pointers. The library looks a pointer up in a table before it uses it, so a wrong
// or old pointer is an error and no crash.

#include <pthread.h>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <unordered_map>
#include <utility>

#include "libspe2.h"
#include "machine.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/ls_sim/cancellation.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_contexts.h"

/// SPE contexts that belong together.
struct spe_gang_context {
  std::atomic<int> contexts{0};
  std::atomic<bool> has_memory_affinity{false};
};

struct spe_context {
  explicit spe_context(unsigned int options) : flags(options) {}
  ~spe_context();
  spe_context(const spe_context&) = delete;
  spe_context& operator=(const spe_context&) = delete;

  softcell::ls_sim::ProblemState& problem_state() { return spe->problem_state(); }

  const unsigned int flags;
  std::shared_ptr<spe_gang_context> gang;
  std::atomic<int> neighbours{0};
  std::unique_ptr<softcell::ls_sim::SpeContext> spe;

  std::atomic<bool> busy{false};       ///< a thread is in spe_context_run() or spe_program_load()
  std::atomic<bool> destroyed{false};  ///< threads that wait for it return
  std::atomic<unsigned int> tags{0};   ///< of proxy commands since the tag status was read
  std::mutex in_mbox;  ///< held while values are written, so that those of one call stay together

  /// The registers that only hold a value until another is used.
  struct Registers {
    softcell::dma::MfcCommand command;
    unsigned int query_mask = 0;
    std::uint32_t spu_status = 0;  ///< of the last stop
  };

  std::mutex mutex;  ///< guards all below
  Registers registers;
  std::shared_ptr<const softcell::ls_sim::KernelImage> image;
  bool goes_on = false;               ///< the last run has stopped so that it can go on
  unsigned int next_entry = 0;        ///< then at this address
  std::deque<spe_stop_info_t> stops;  ///< not read yet, the oldest first; of contexts with events
  std::atomic<bool> has_stop{false};  ///< whether there is one, for who waits
};

namespace softcell::libspe2 {

/// The objects of one type that the program has. Any thread.
template <class Object>
class Objects {
 public:
  /// All objects of the process; never destroyed.
  static Objects& all() {
    static auto* const objects = new Objects;
    return *objects;
  }
  Object* add(std::shared_ptr<Object> object) {
    Object* const key = object.get();
    const std::lock_guard lock(mutex_);
    objects_.emplace(key, std::move(object));
    return key;
  }
  /// @return  null: there is none, or no longer.
  std::shared_ptr<Object> find(const void* key) {
    const std::lock_guard lock(mutex_);
    const auto found = objects_.find(key);
    return found == objects_.end() ? nullptr : found->second;
  }
  /// The first for which condition(object) is true; null: none.
  template <class Condition>
  std::shared_ptr<Object> find_if(Condition&& condition) {
    const std::lock_guard lock(mutex_);
    for (const auto& [key, object] : objects_) {
      if (condition(*object)) return object;
    }
    return nullptr;
  }
  template <class Work>
  void for_each(Work&& work) {
    const std::lock_guard lock(mutex_);
    for (const auto& [key, object] : objects_) work(*object);
  }
  /// @return  null: there was none.
  std::shared_ptr<Object> remove(const void* key) {
    const std::lock_guard lock(mutex_);
    const auto found = objects_.find(key);
    if (found == objects_.end()) return nullptr;
    std::shared_ptr<Object> object = std::move(found->second);
    objects_.erase(found);
    return object;
  }

 private:
  std::mutex mutex_;
  std::unordered_map<const void*, std::shared_ptr<Object>> objects_;
};

inline std::shared_ptr<spe_context> context_of(spe_context_ptr_t spe) {
  return Objects<spe_context>::all().find(spe);
}

/// Sets errno. @return  -1
inline int fail(int error) {
  errno = error;
  return -1;
}

/// While the object lives, the calling thread cannot be cancelled, except in the waits that `Waits` names: a thread that is
/// cancelled elsewhere would leave the list of waiting threads wrong.
class NotCancelled {
 public:
  NotCancelled() {
    pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &before_);
    pthread_setcanceltype(PTHREAD_CANCEL_DEFERRED, &type_before_);
  }
  ~NotCancelled() {
    pthread_setcanceltype(type_before_, nullptr);
    pthread_setcancelstate(before_, nullptr);
  }
  NotCancelled(const NotCancelled&) = delete;
  NotCancelled& operator=(const NotCancelled&) = delete;

  /// Whether the caller of the library may be cancelled, at cancellation points or anywhere.
  bool allowed() const { return before_ == PTHREAD_CANCEL_ENABLE; }
  bool allowed_anywhere() const { return allowed() && type_before_ == PTHREAD_CANCEL_ASYNCHRONOUS; }

 private:
  int before_ = 0, type_before_ = 0;
};

/// What a function of the library waits for, so that a thread may be cancelled within. As on the Cell's Linux a run is no cancellation
/// point: only a thread that may be cancelled anywhere leaves it before it has stopped.
enum class Waits : std::uint8_t { kNo, kForEvents, kForARun };

/// Calls work() for a caller in C: turns exceptions into errno. @param failure  the result then.
template <class Result, class Work>
Result shielded(Result failure, Work&& work, Waits waits = Waits::kNo) {
  const NotCancelled here;
  std::optional<ls_sim::MayBeCancelled> point;
  if (waits == Waits::kForEvents ? here.allowed() : waits == Waits::kForARun && here.allowed_anywhere())
    point.emplace();
  try {
    return work();
  } catch (const std::bad_alloc&) {
    errno = ENOMEM;
  } catch (const std::exception& error) {
    Machine::complain(error.what());
    errno = EFAULT;
  }
  return failure;
}

/// Calls work(context); ESRCH if there is no such context.
template <class Work>
int with_context(spe_context_ptr_t spe, Work&& work, Waits waits = Waits::kNo) {
  return shielded(
      -1,
      [&] {
        const std::shared_ptr<spe_context> context = context_of(spe);
        return context == nullptr ? fail(ESRCH) : work(*context);
      },
      waits);
}

}  // namespace softcell::libspe2
