#pragma once
// How SPEs run: shared by job systems and by SPEs started one by one (SpeGroup).

#include <chrono>
#include <cstdint>

#include "softcell/dma/addresses.h"
#include "softcell/dma/schedule.h"

namespace softcell::ls_sim {

class Trace;
class Findings;

/// What time is to a kernel: the decrementer's, and what `random:SEED` may depend on.
enum class Clock : std::uint8_t {
  kHost,       ///< the host's steady clock
  kSimulated,  ///< advances with each channel operation, so that a run is the same every time
};

/// Which SPE goes on when.
enum class Interleaving : std::uint8_t {
  kFree,   ///< all at once, as the host's threads go
  kTurns,  ///< one at a time; who is next at a channel operation is drawn from the schedule's seed, so that a
           ///< run of several SPEs is reproducible
};

struct SpeOptions {
  int spes = dma::kSpeCount;  ///< 1..6
  dma::Schedule schedule{};
  std::chrono::milliseconds deadline{10'000};  ///< for one run; one that takes longer is stopped with a fault
  Clock clock = Clock::kHost;
  Interleaving interleaving = Interleaving::kFree;
  bool measure_stack = false;  ///< scan the stack after each run
  bool reload_always = false;  ///< copy the image in before every run, so that bss starts as zero
  Findings* findings =
      nullptr;  ///< checked images report here; an image that is not checked is refused. Outlives all
  Trace* trace = nullptr;  ///< null: nothing is recorded. Outlives all
};

}  // namespace softcell::ls_sim
