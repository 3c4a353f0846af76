#pragma once
// The monitor of a group of SPEs: it knows which SPE runs, which sleeps at which channel, and which runs
// next.
//
//   SPE 0   runs ---- sleep(reads SPU_RdInMbox) ................ runs ---- end()
//   SPE 1   runs ----------------- writes the mailbox, wake(0) -- runs - sleep() ... nobody left: deadlock
//   PPU     start(0) start(1) -- ppu_wait() ............................................... runs
//
// Its mutex also guards what an SPE may wait for (mailboxes, signals, events), so that a sleeping SPE never
// misses the change that it waits for. Nobody holds it while an MFC or a kernel runs.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/dma/random_stream.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_options.h"

namespace softcell::ls_sim {

/// What a sleeping SPE waits for.
struct Sleep {
  std::uint32_t channel = 0;
  dma::LocalStoreAddress position;  ///< of the instruction that waits

  // When it wakes by itself, if it does: at this time of the host, or after so many ticks of simulated time.
  std::optional<std::chrono::steady_clock::time_point> until = {};
  std::optional<std::uint64_t> simulated_ticks = {};
};

/// Why an SPE woke up. It may have woken spuriously: it checks its condition again.
enum class Woken : std::uint8_t {
  kToLook,
  kDeadlock,  ///< deadlock() says why
  kStopped,   ///< by stop()
};

class SpeMonitor {
 public:
  using Lock = std::unique_lock<std::mutex>;
  using HostTime = std::chrono::steady_clock::time_point;

  /// Whether the PPU side acts in calls of the monitor only, or is a program of its own that may act at any
  /// time: then SPEs run whatever the PPU side does, and there is no deadlock.
  enum class PpuSide : std::uint8_t { kInside, kOutside };

  explicit SpeMonitor(const SpeOptions& options, PpuSide ppu_side = PpuSide::kInside);

  Lock lock() { return Lock(mutex_); }

  // Runs of SPEs. All with the lock.

  /// From now on the SPE counts as running, even if its thread still has to wake up. @pre it does not run
  /// @param timed  whether its deadline counts from now; else only that of jobs inside the run does.
  void start(int spe, const KernelImage& image, HostTime now, bool timed = true);

  /// A job begins or has ended inside the run.
  void begin_job(int spe, HostTime now) {
    SC_ASSERT(runs(spe), "a job begins in SPE {}, which does not run", spe);
    member(spe).started = now;
  }
  void end_job(int spe) {
    SC_ASSERT(member(spe).started.has_value(), "a job ends in SPE {}, and none has begun", spe);
    member(spe).started.reset();
  }
  void end(int spe);
  bool runs(int spe) const { return members_[index(spe)].state != State::kIdle; }
  /// The same, without the lock.
  bool runs_now(int spe) {
    const Lock now = lock();
    return runs(spe);
  }
  /// Whether the run or job of the SPE has taken longer than the deadline.
  bool is_late(int spe, HostTime now, std::chrono::milliseconds deadline) const {
    const auto& started = members_[index(spe)].started;
    return started && now - *started > deadline;
  }

  /// Ends the SPE's sleeps from now until its run has ended.
  void stop(int spe);

  // For the SPE's own thread, while it runs.

  /// At the beginning of a run, with the lock: waits for its turn. @return  false when it has been stopped.
  bool await_first_turn(Lock& lock, int spe);

  /// At each channel operation, without the lock: the turn may go to another SPE and come back.
  /// @return  false when the SPE has been stopped meanwhile.
  bool pass_turn(int spe) { return !takes_turns_ || pass_turn_now(spe); }

  /// Sleeps until wake() is called, or for another reason of Woken. If SPEs run freely, it polls for a while before it sleeps.
  Woken sleep(Lock& lock, int spe, const Sleep& sleep);

  /// Ticks of simulated time that went by in the SPE's last sleep, whatever ended it. With the lock.
  std::uint64_t slept_ticks(int spe) const { return members_[index(spe)].slept_ticks; }

  /// A sentence that says which SPE waits for what, of the last deadlock. With the lock.
  const std::string& deadlock() const { return deadlock_; }

  // The SPE's simulated clock, with Interleaving::kByTime. For the SPE's own thread, without the lock. Times are in cycles.

  /// Sets the time of the SPE's next operation, and the time at which others see its effect.
  void set_time(int spe, std::uint64_t now, std::uint64_t effect);
  /// The time of the event that woke the SPE since the last call; 0: it has not slept.
  std::uint64_t take_woken_at(int spe);
  /// The time at which an SPE begins a run: its own time or that of the last run that has ended, whichever is later.
  std::uint64_t time_at_start(int spe);

  // For threads that have changed something for which others may wait. With the lock.

  void wake(int spe);
  void wake_ppu();

  // For the PPU side, which may wake SPEs at any time except in ppu_wait(). All with the lock.

  /// Sleeps until `ready`, which is called with the lock, returns true, or until the time has come. Meanwhile
  /// the PPU side counts as waiting.
  /// @return  the last answer of `ready`.
  bool ppu_wait(Lock& lock, const std::function<bool()>& ready, std::optional<HostTime> until = {});

  /// Sleeps until no SPE runs or will run by itself. With the lock. @pre SPEs take turns
  void ppu_wait_until_idle(Lock& lock);

  /// The PPU side has polled without success: if SPEs take turns, one of them runs for a while.
  void ppu_pause(Lock& lock);

  /// Changes the number of other threads that may act as the PPU while all here wait.
  void change_outside(int difference);

 private:
  enum class State : std::uint8_t { kIdle, kRunnable, kAsleep };

  struct Member {
    State state = State::kIdle;
    bool stopped = false;
    Woken woken = Woken::kToLook;
    const KernelImage* image = nullptr;
    std::optional<HostTime> started;  ///< what has a deadline
    Sleep sleep;
    std::uint64_t slept_ticks = 0;  ///< simulated, in this sleep so far
    std::uint64_t time = 0;         ///< cycles, by its own clock
    std::uint64_t woken_at = 0;     ///< cycles
    std::condition_variable wake_up;
    std::atomic<bool> called = false;  ///< since it has begun to look: read without the lock

    void call() {
      called.store(true, std::memory_order_relaxed);
      wake_up.notify_one();
    }
  };

  static constexpr int kNobody = -1;

  std::size_t index(int spe) const {
    SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of {}", spe, spes());
    return static_cast<std::size_t>(spe);
  }
  int spes() const { return static_cast<int>(members_.size()); }
  Member& member(int spe) { return members_[index(spe)]; }
  bool has_turn(int spe) const { return !takes_turns_ || turn_ == spe; }
  bool may_go_on(int spe) {
    return member(spe).stopped || (member(spe).state == State::kRunnable && has_turn(spe));
  }
  void look(Lock& lock, int spe);
  bool any(State state) const;
  bool is_idle() const;
  std::span<Member> used() { return std::span(members_).first(members_used_); }
  std::span<const Member> used() const { return std::span(members_).first(members_used_); }

  bool pass_turn_now(int spe);
  bool is_behind(int spe) const;
  void give_up_turn(int spe);
  void wake_with(int spe, Woken why);

  void leave_ppu_wait(const std::function<bool()>* wait);
  bool ppu_acts() const;
  void settle();
  void draw_turn();
  bool let_time_pass();
  void pass_ticks(Member& member, std::uint64_t ticks);
  void declare_deadlock();

  const bool takes_turns_;
  const bool by_time_;
  const bool may_look_;
  const PpuSide ppu_side_;

  static constexpr int kNobodyLooks = std::numeric_limits<int>::max();
  std::atomic<int> looks_ = kNobodyLooks;  // which SPE; read without the lock

  std::mutex mutex_;  // guards all below, and what SPEs wait for
  std::vector<Member> members_;
  std::size_t members_used_ = 0;  ///< that have ever run: the first ones
  std::vector<int> runnable_;     ///< scratch of draw_turn()
  std::condition_variable ppu_wake_up_;
  std::vector<const std::function<bool()>*> ppu_waits_;
  int outside_;
  std::string deadlock_;

  // Of time:
  std::uint64_t effect_time_ = 0;  ///< of what the SPE whose turn it is does now
  std::uint64_t ended_time_ = 0;   ///< of the last run that has ended

  // Of turns:
  int turn_ = kNobody;
  std::uint32_t operations_left_ = 0;  ///< of whose turn it is
  std::uint64_t turns_drawn_ = 0;
  dma::RandomStream random_;
};

}  // namespace softcell::ls_sim
