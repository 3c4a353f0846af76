#pragma once
// What happened when: jobs, DMA commands, waits and findings of each SPE, for `--trace` and `softcell
// report`.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "softcell/dma/fault.h"
#include "softcell/dma/mfc_observer.h"
#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

/// Nanoseconds of the host's steady clock.
using TraceTime = std::int64_t;
TraceTime trace_now();

/// One SPE's part of a trace. Used by the thread that runs the SPE; recording allocates only when its memory
/// grows.
class SpeTrace final : public dma::MfcObserver {
 public:
  SpeTrace();
  ~SpeTrace() override;

  void on_job(const KernelImage& image, std::uint64_t job_number, TraceTime begin, TraceTime end,
              bool failed);

  /// A channel operation that had to wait: a tag status, a full queue, an empty mailbox, an event.
  void on_wait(std::uint32_t channel, TraceTime begin, TraceTime end);

  void on_finding(const dma::Fault& fault, TraceTime when);

  // dma::MfcObserver: DMA commands from issue to completion.
  void on_issue(std::uint64_t number, const dma::MfcCommand& command, std::uint64_t bytes) override;
  void on_complete(std::uint64_t number) override;

 private:
  friend class Trace;
  struct Events;
  std::unique_ptr<Events> events_;
};

/// A run's trace. Hand `spe(n)` to SPE n while it runs; write when all have stopped.
class Trace {
 public:
  explicit Trace(int spes);
  ~Trace();

  SpeTrace& spe(int number);
  int spes() const;

  /// Writes the Chrome / Perfetto JSON format: one process, one thread for each SPE's jobs, waits and
  /// commands, and for each image its local-store map as metadata. The file appears whole or not at all.
  /// @throws std::runtime_error  the file cannot be written; the sentence says why.
  void write(const std::filesystem::path& file) const;

 private:
  std::vector<std::unique_ptr<SpeTrace>> spes_;
  TraceTime begin_;
};

}  // namespace softcell::ls_sim
