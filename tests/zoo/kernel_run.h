#pragma once
// One run of a zoo kernel in surroundings of its own.

#include <vector>

#include "kernel_card.h"
#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/image.h"

namespace softcell::zoo {

enum class Build { kPlain, kChecked };

/// What came of it.
struct Observation {
  std::vector<ls_sim::RunResult> results;  ///< of each SPE
  std::vector<ls_sim::Finding> findings;
};

/// argp leads to 64 KB of words, each of which is its own index.
/// @param machine  kSpu: the kernel as built for the SPU, by the interpreter; only with a compiler for the SPU
Observation run(const KernelCard& card, Build build, const dma::Schedule& schedule,
                ls_sim::Machine machine = ls_sim::Machine::kHost);

}  // namespace softcell::zoo
