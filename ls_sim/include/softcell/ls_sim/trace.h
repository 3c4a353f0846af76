#pragma once
// A trace: the jobs, DMA commands, waits and findings of each SPE with their times, for `--trace` and
// `softcell report`. docs/guide/running-kernels.md describes the file.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "softcell/dma/fault.h"
#include "softcell/dma/mfc_observer.h"
#include "softcell/ls_sim/image.h"

namespace softcell::base {
class WholeFile;
}

namespace softcell::ls_sim {

/// Nanoseconds by the trace's clock.
using TraceTime = std::int64_t;
/// The time now by the host's clock. Any thread.
TraceTime trace_now();

/// The clock of a trace's times: the host's steady clock, or the SPEs' simulated clocks (SpeOptions::timing).
enum class TraceClock : std::uint8_t { kHost, kSimulated };

struct SpeEvents;
struct TracedCommand;

/// One SPE's part of a trace. Used by the thread that runs the SPE. Recording an event reads the clock and
/// appends to a log, and allocates memory only when the log grows. Beyond the limit of the trace, events are
/// counted and dropped.
class SpeTrace final : public dma::MfcObserver {
 public:
  ~SpeTrace() override;
  SpeTrace(const SpeTrace&) = delete;
  SpeTrace& operator=(const SpeTrace&) = delete;

  TraceClock clock() const { return clock_; }
  /// The time now: by the host's clock, or the last one passed to set_time().
  TraceTime now() const { return clock_ == TraceClock::kHost ? trace_now() : simulated_now_; }

  // These are for a simulated clock.
  void set_time(TraceTime now) { simulated_now_ = now; }
  /// The command that was recorded last, for complete_at().
  std::size_t last_command() const;
  /// Sets when a command is complete, whatever the order in which its bytes have moved here.
  void complete_at(std::size_t command, TraceTime when);

  /// Records a run that has ended. Copies the declarations of an image when the image first occurs.
  /// @pre  begin <= end
  /// @param failed  true if it ended by a fault, or with another status than 0 (SpeOptions::status_says_failure).
  void on_job(const KernelImage& image, std::uint64_t job_number, TraceTime begin, TraceTime end,
              bool failed);

  /// Records how much stack a run of the image used, in bytes. The trace keeps the maximum.
  void on_stack_used(const KernelImage& image, std::uint32_t bytes);

  /// Records a channel operation that had to wait: for a tag status, a full queue, an empty mailbox, an
  /// event.
  /// @pre  begin <= end
  void on_wait(std::uint32_t channel, TraceTime begin, TraceTime end);

  /// Records a finding. If this SPE has made the same mistake before, it is only counted.
  void on_finding(const dma::Fault& fault, TraceTime when);

  // dma::MfcObserver: DMA commands from issue to completion. If a fault ends a job before a command
  // completes, the trace shows the command up to the end of that job.
  void on_issue(std::uint64_t number, const dma::MfcCommand& command, std::uint64_t bytes) override;
  void on_complete(std::uint64_t number) override;
  void on_reservation_lost(std::uint64_t number) override;

 private:
  friend class Trace;
  SpeTrace(std::size_t most_events, TraceClock clock);

  /// Completes a command in flight. Null if the log had no room for it.
  TracedCommand* complete(std::uint64_t number);

  std::unique_ptr<SpeEvents> events_;
  const TraceClock clock_;
  TraceTime simulated_now_ = 0;
  std::size_t last_command_ = 0;
};

/// The trace of a run. SPE n records to spe(n) while it runs; call write() when all SPEs have stopped.
class Trace {
 public:
  /// 4 million events per SPE are enough for half an hour of a demo; its commands then take 160 MB.
  static constexpr std::size_t kMostEvents = 4'000'000;

  /// @param spes         1 or more.
  /// @param most_events  for each SPE and kind: jobs, waits, commands, findings.
  /// @throws std::invalid_argument  there are fewer SPEs than 1.
  explicit Trace(int spes, std::size_t most_events = kMostEvents, TraceClock clock = TraceClock::kHost);
  ~Trace();

  /// @pre 0 <= number < spes()
  SpeTrace& spe(int number);
  int spes() const;
  TraceClock clock() const { return clock_; }

  /// Writes the Chrome / Perfetto JSON format: one process for each SPE with rows for its jobs, its waits and
  /// its overlapping commands, findings as instants, and for each image its local-store map. Time 0 is the
  /// construction of the trace, or that of the simulated clocks. The file is written atomically.
  /// @throws std::runtime_error  the file cannot be written; the message says why.
  void write(const std::filesystem::path& file) const;
  /// Writes the same to a file that the caller commits.
  void write(base::WholeFile& file) const;

 private:
  std::vector<std::unique_ptr<SpeTrace>> spes_;
  TraceTime begin_;
  const TraceClock clock_;
};

}  // namespace softcell::ls_sim
