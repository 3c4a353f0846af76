#pragma once
// What an SpeGroup consists of: SPEs, a thread for each, and the watchdog that ends runs which
// take too long.

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "softcell/base/assert.h"
#include "spe.h"

namespace softcell::ls_sim {

/// Who gives the SPEs their runs. Called by the SPEs' threads.
class RunSource {
 public:
  virtual ~RunSource() = default;

  /// Waits for a run for this SPE; releases the lock meanwhile. The caller has told the monitor of its start.
  /// @return  nothing when the thread is to end.
  virtual std::optional<Run> next_run(int spe, SpeMonitor::Lock& lock) = 0;

  /// Called with the lock, after the SPE's run.
  virtual void on_ended(int spe, const Run& run, RunResult&& result) = 0;
};

class SpeThreads {
 public:
  /// @param source  outlives this; called as soon as all threads run, before the constructor returns.
  /// @throws std::invalid_argument  options out of range.
  /// @throws std::runtime_error     when the host cannot run native kernels, or has no thread left.
  SpeThreads(dma::AddressSpace& memory, const SpeOptions& options, RunSource& source);

  ~SpeThreads() { join(); }
  SpeThreads(const SpeThreads&) = delete;
  SpeThreads& operator=(const SpeThreads&) = delete;

  /// Waits for the threads. @pre the source gives no more runs.
  void join();

  /// All runs in progress end with a fault. With the lock.
  void stop_runs();

  SpeMonitor& monitor() { return monitor_; }
  Spe& spe(int number) { return *workers_[index(number)]; }
  int spes() const { return options_.spes; }

  /// Exact when the SPE does not run, else as of its last run or job. With the lock.
  const SpeStatistics& statistics(int spe) const { return workers_[index(spe)]->statistics(); }

 private:
  std::size_t index(int spe) const {
    SC_ASSERT(spe >= 0 && spe < spes(), "SPE {} of a group of {}", spe, spes());
    return static_cast<std::size_t>(spe);
  }
  enum class Beginning : std::uint8_t { kNotYet, kNow, kNever };

  void begin_work(Beginning beginning);
  void work(int number);
  RunResult run(int number, const Run& run, SpeMonitor::Lock& lock);
  void watch();

  const SpeOptions options_;
  RunSource& source_;
  SpeMonitor monitor_;
  std::vector<std::unique_ptr<Spe>> workers_;

  // Guarded by the monitor's lock:
  std::condition_variable began_, watchdog_wake_up_;
  Beginning beginning_ = Beginning::kNotYet;
  bool stops_runs_ = false, closed_ = false;

  std::vector<std::jthread> threads_;
  std::jthread watchdog_;
};

}  // namespace softcell::ls_sim
