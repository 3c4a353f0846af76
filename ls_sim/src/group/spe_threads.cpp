#include "spe_threads.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"
#include "softcell/ls_sim/timing.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::ls_sim {
namespace {

/// On a console an SPE never takes time from the PPU. Here both share cores: a batch thread at least does not
/// interrupt the thread that wakes it. Where the host refuses, only timings suffer.
void leave_the_ppu_its_core() {
  const sched_param parameters{};
  pthread_setschedparam(pthread_self(), SCHED_BATCH, &parameters);
}

const SpeOptions& checked(const SpeOptions& options) {
  if (options.spes < 1 || options.spes > dma::kSpeCount) {
    throw std::invalid_argument("the number of SPEs is " + std::to_string(options.spes) + "; 1 to " +
                                std::to_string(dma::kSpeCount) + " are allowed");
  }
  if (options.deadline <= std::chrono::milliseconds::zero()) {
    throw std::invalid_argument("the deadline of a run is " + std::to_string(options.deadline.count()) +
                                " ms; it must be above 0");
  }
  if (options.trace != nullptr && options.trace->spes() < options.spes) {
    throw std::invalid_argument("the trace has room for " + std::to_string(options.trace->spes()) +
                                " SPEs; there are " + std::to_string(options.spes));
  }
  const bool is_by_time = options.interleaving == Interleaving::kByTime;
  if (is_by_time != (options.timing != nullptr) || (is_by_time && options.clock != Clock::kSimulated)) {
    throw std::invalid_argument(
        "SpeOptions::timing needs interleaving = kByTime and clock = kSimulated, and kByTime needs timing; "
        "time_by() sets all three");
  }
  if (options.trace != nullptr && (options.trace->clock() == TraceClock::kSimulated) != is_by_time) {
    throw std::invalid_argument(is_by_time ? "the trace has the host's clock, and the SPEs are timed: "
                                             "construct it with TraceClock::kSimulated"
                                           : "the trace has the simulated clock, and the SPEs are not timed: "
                                             "construct it with TraceClock::kHost");
  }
  if (options.timing != nullptr && options.timing->spes() < options.spes) {
    throw std::invalid_argument("the timing has room for " + std::to_string(options.timing->spes()) +
                                " SPEs; there are " + std::to_string(options.spes));
  }
  return options;
}

}  // namespace

SpeThreads::SpeThreads(dma::AddressSpace& memory, const SpeOptions& options, RunSource& source)
    : options_(checked(options)), source_(source), monitor_(options) {
  for (int number = 0; number < options_.spes; ++number) {
    workers_.push_back(std::make_unique<Spe>(number, memory, options_, monitor_));
  }
  try {
    for (int number = 0; number < options_.spes; ++number) {
      threads_.emplace_back([this, number] { work(number); });
    }
    watchdog_ = std::jthread([this] { watch(); });
  } catch (...) {
    begin_work(Beginning::kNever);  // so that the threads that were made end
    throw;
  }
  begin_work(Beginning::kNow);
}

void SpeThreads::begin_work(Beginning beginning) {
  {
    const SpeMonitor::Lock lock = monitor_.lock();
    SC_ASSERT(beginning_ == Beginning::kNotYet && beginning != Beginning::kNotYet,
              "the threads' beginning {} becomes {}", beginning_, beginning);
    beginning_ = beginning;
  }
  began_.notify_all();
}

void SpeThreads::join() {
  threads_.clear();  // the watchdog still ends what takes too long
  {
    const SpeMonitor::Lock lock = monitor_.lock();
    closed_ = true;
  }
  watchdog_wake_up_.notify_one();
  if (watchdog_.joinable()) watchdog_.join();
}

void SpeThreads::stop_runs() {
  stops_runs_ = true;
  watchdog_wake_up_.notify_one();
}

void SpeThreads::work(int number) {
  leave_the_ppu_its_core();
  SpeMonitor::Lock lock = monitor_.lock();
  began_.wait(lock, [this] { return beginning_ != Beginning::kNotYet; });
  if (beginning_ == Beginning::kNever) return;
  while (const std::optional<Run> next = source_.next_run(number, lock)) {
    RunResult result = run(number, *next, lock);
    SC_ASSERT(lock.owns_lock(), "SPE {} ends run {} without the lock", number, next->number);
    monitor_.end(number);
    spe(number).publish_statistics();
    source_.on_ended(number, *next, std::move(result));
  }
}

RunResult SpeThreads::run(int number, const Run& run, SpeMonitor::Lock& lock) {
  SC_ASSERT(lock.owns_lock() && run.image != nullptr, "run {} of SPE {} without the lock or an image",
            run.number, number);
  if (!monitor_.await_first_turn(lock, number)) {
    return {0, dma::Fault{.rule = dma::Rule::kDeadlineExceeded,
                          .spe = number,
                          .kernel = run.image->name,
                          .detail = "the kernel was stopped before its first instruction"}};
  }
  lock.unlock();
  RunResult result = spe(number).run(run);
  lock.lock();
  return result;
}

/// Every wait for a run ends because this loop ends the run.
void SpeThreads::watch() {
  using namespace std::chrono_literals;
  const auto period = std::clamp<std::chrono::milliseconds>(options_.deadline / 8, 1ms, 100ms);
  SpeMonitor::Lock lock = monitor_.lock();
  while (!closed_) {
    watchdog_wake_up_.wait_for(lock, stops_runs_ ? 1ms : period);
    const auto now = std::chrono::steady_clock::now();
    for (int number = 0; number < options_.spes; ++number) {
      const bool late = stops_runs_ || monitor_.is_late(number, now, options_.deadline);
      if (late && monitor_.runs(number)) spe(number).interrupt(Spe::Interrupt::kLate);
    }
  }
}

}  // namespace softcell::ls_sim
