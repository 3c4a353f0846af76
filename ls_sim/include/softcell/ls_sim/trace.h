#pragma once
// What happened when: jobs, DMA commands, waits and findings of each SPE, for `--trace` and `softcell
// report`. docs/guide/running-kernels.md describes the file.

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

/// Nanoseconds of the host's steady clock.
using TraceTime = std::int64_t;
TraceTime trace_now();

struct SpeEvents;
struct TracedCommand;

/// One SPE's part of a trace. Used by the thread that runs the SPE. Recording an event is a look at the clock
/// and an append: it allocates only when the memory grows. Past the limit of a trace, further events are
/// counted and dropped.
class SpeTrace final : public dma::MfcObserver {
 public:
  ~SpeTrace() override;
  SpeTrace(const SpeTrace&) = delete;
  SpeTrace& operator=(const SpeTrace&) = delete;

  /// A run that has ended. What the image declares is copied when it is first seen.
  /// @param failed  by a fault, or with another status than 0.
  void on_job(const KernelImage& image, std::uint64_t job_number, TraceTime begin, TraceTime end,
              bool failed);

  /// Stack that the image was seen to use, in bytes; the most of all calls is kept.
  void on_stack_used(const KernelImage& image, std::uint32_t bytes);

  /// A channel operation that had to wait: a tag status, a full queue, an empty mailbox, an event.
  void on_wait(std::uint32_t channel, TraceTime begin, TraceTime end);

  /// A mistake that this SPE has made before is only counted.
  void on_finding(const dma::Fault& fault, TraceTime when);

  // dma::MfcObserver: DMA commands from issue to completion. A command that never completes, because a fault
  // ended its job, is drawn to the end of that job.
  void on_issue(std::uint64_t number, const dma::MfcCommand& command, std::uint64_t bytes) override;
  void on_complete(std::uint64_t number) override;
  void on_reservation_lost(std::uint64_t number) override;

 private:
  friend class Trace;
  explicit SpeTrace(std::size_t most_events);

  /// Ends a command that is under way. Null when the log had no room for it.
  TracedCommand* complete(std::uint64_t number);

  std::unique_ptr<SpeEvents> events_;
};

/// A run's trace. Hand `spe(n)` to SPE n while it runs; write when all have stopped.
class Trace {
 public:
  /// 4 million events an SPE are half an hour of a demo, and of commands at most 160 MB.
  static constexpr std::size_t kMostEvents = 4'000'000;

  /// @param spes         1 or more.
  /// @param most_events  of each SPE and kind: jobs, waits, commands, findings.
  explicit Trace(int spes, std::size_t most_events = kMostEvents);
  ~Trace();

  SpeTrace& spe(int number);
  int spes() const;

  /// Writes the Chrome / Perfetto JSON format: one process for each SPE with rows for its jobs, its waits and
  /// its overlapping commands, findings as instants, and for each image its local-store map. Times count from
  /// the construction of the trace. The file appears whole or not at all.
  /// @throws std::runtime_error  the file cannot be written; the sentence says why.
  void write(const std::filesystem::path& file) const;
  /// The same, all that is in a file that the caller commits.
  void write(base::WholeFile& file) const;

 private:
  std::vector<std::unique_ptr<SpeTrace>> spes_;
  TraceTime begin_;
};

}  // namespace softcell::ls_sim
