#pragma once
// What all contexts of the process share: main storage, which is the process's own memory, and what is found out
// about the program.

#include <sys/types.h>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>

#include "settings.h"
#include "softcell/dma/address_space.h"
#include "softcell/dma/fault.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/spe_contexts.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::libspe2 {

inline constexpr int kMostContexts = 256;

/// Any thread. It is made at the first call of the library and never destroyed: SPE threads may outlive main().
class Machine {
 public:
  /// Ends the process with status 2 if the environment has a setting that is not allowed, or the host cannot run
  /// SPEs; standard error says why.
  static Machine& get();

  const Settings& settings() const { return settings_; }
  ls_sim::SpeContexts& contexts() { return *contexts_; }
  dma::AddressSpace& memory() { return memory_; }

  /// Says on standard error what a kernel has done wrong, and counts it.
  void report(const dma::Fault& fault);

  /// Says on standard error why something failed.
  static void complain(std::string_view what);

  /// Ends the process at once, with its reports, because the program may never end by itself.
  [[noreturn]] void end_process(int status);
  /// Whether the end of the process ends all runs.
  bool is_ending() const { return ending_thread_ != 0; }
  /// Does not return if the process ends. As on the Cell, the last calls of its threads have no results.
  void stay_if_ending() const;
  /// For the process's last moments. Only the first call has an effect; another thread's does not return.
  static void at_exit();

  void count_context();
  void count_run() { runs_.fetch_add(1, std::memory_order_relaxed); }
  /// The run that was counted could not begin.
  void uncount_run() { runs_.fetch_sub(1, std::memory_order_relaxed); }
  /// Call it when a run has ended, after report(). It brings the report up to date with what was found: a program may end
  /// without its exit handlers, by _exit() or a signal.
  void end_run();
  /// Adds the transfers of a context that is about to be destroyed to the statistics. A context that has stopped makes no more transfers.
  void count_last(ls_sim::SpeContext& context);

 private:
  Machine();
  void end_runs();
  void count_contexts();
  void print_findings() const;
  void write_trace() const;
  enum class Report { kSoFar, kWhole };
  void write_report(Report which) const;
  void write_report_so_far();

  std::atomic<pid_t> ending_thread_{0};  ///< 0: the process goes on
  const Settings settings_;
  const int process_;
  dma::AddressSpace memory_;
  ls_sim::Findings findings_, faults_;
  std::unique_ptr<ls_sim::Trace> trace_;
  std::unique_ptr<ls_sim::SpeContexts> contexts_;
  std::atomic<std::uint64_t> contexts_made_{0}, runs_{0}, commands_{0}, bytes_{0};
  std::mutex report_mutex_;  ///< guards the file and what follows
  std::size_t reported_mistakes_ = 0;
};

/// The address at which a program finds the blocks of its heap: an allocator that was loaded before the C library,
/// if there is one.
const dma::HostAllocations* interposed_allocations();

}  // namespace softcell::libspe2
