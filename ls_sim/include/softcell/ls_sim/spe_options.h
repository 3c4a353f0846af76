#pragma once
// Options for running SPEs, in a SpeGroup and in a job system.

#include <chrono>
#include <cstdint>

#include "softcell/dma/addresses.h"
#include "softcell/dma/schedule.h"

namespace softcell::ls_sim {

class Debugger;
struct HostCalls;
class Timing;
class Trace;
class Findings;

/// The clock of a kernel's decrementer.
enum class Clock : std::uint8_t {
  kHost,       ///< the host's steady clock
  kSimulated,  ///< advances with each channel operation, so that a run is the same every time
};

/// How SPEs run relative to each other.
enum class Interleaving : std::uint8_t {
  /// All at once, each on a thread of the host.
  kFree,
  /// One at a time. At a channel operation the turn may pass to another SPE, drawn from the schedule's seed,
  /// so that runs of several SPEs are reproducible.
  kTurns,
  /// One at a time, and always the one whose simulated clock is behind the others, so that shared resources are used in the order of time.
  /// Needs SpeOptions::timing.
  kByTime,
};

/// How SPEs run. Every field has a default.
struct SpeOptions {
  int spes = dma::kSpeCount;  ///< 1..6
  dma::Schedule schedule{};
  std::chrono::milliseconds deadline{10'000};  ///< for one run; a longer run is stopped with a fault
  Clock clock = Clock::kHost;
  Interleaving interleaving = Interleaving::kFree;
  bool measure_stack = false;  ///< scan the stack after each run
  /// Checked images report their findings here; images that are not checked are refused then. Null: nothing is checked. It must outlive the
  /// SPEs.
  Findings* findings = nullptr;
  /// The calls that the host serves for programs built for the SPU (host_calls.h). Null: none. It must outlive the SPEs.
  const HostCalls* host_calls = nullptr;
  /// Collects cycles: for programs built for the SPU with the model of its pipelines, for all programs with the model of transfers. Needs
  /// Clock::kSimulated and Interleaving::kByTime. Null: nothing is timed. It must outlive the SPEs.
  Timing* timing = nullptr;
  /// Called before each instruction (debugger.h). Programs built for the SPU are not timed then. Null: no debugger. It must outlive the
  /// SPEs.
  Debugger* debugger = nullptr;
  /// A trace shows a run as failed if it ends by a fault or, unless this is false, with another status than 0 or another stop.
  bool status_says_failure = true;
  Trace* trace = nullptr;  ///< null: nothing is recorded. It must outlive the SPEs
};

/// Sets options so that SPEs run by the timing model. @param timing  if null, the options do not change
inline void time_by(Timing* timing, SpeOptions& options) {
  if (timing == nullptr) return;
  options.timing = timing;
  options.clock = Clock::kSimulated;
  options.interleaving = Interleaving::kByTime;
}

}  // namespace softcell::ls_sim
