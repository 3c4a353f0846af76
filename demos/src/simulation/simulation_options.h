#pragma once

#include <cstdint>

#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/spe_options.h"
#include "softcell/ls_sim/trace.h"
#include "softcell/spu_kernels/load_kernel.h"

namespace softcell::demos {

/// Who does shape matching and damping.
enum class Solver {
  kSpe,       ///< the kernels, on the SPEs
  kReference  ///< the PPU, with Eigen
};

/// Who makes mesh vertices from particles, in three dimensions.
enum class Skin {
  kSpe,  ///< the kernel `skin`, on the SPEs
  kGpu   ///< whoever draws, from the particles
};

/// How a scene is simulated. Only the solver changes the result, and that by rounding.
struct SimulationOptions {
  Solver solver = Solver::kSpe;
  Skin skin = Skin::kSpe;
  int spes = 6;
  dma::Schedule schedule{};
  ls_sim::Findings* findings = nullptr;  ///< where checked kernels report; null: kernels are not checked
  ls_sim::Trace* trace = nullptr;        ///< of at least as many SPEs; null: nothing is recorded

  ls_sim::SpeOptions spe_options() const {
    return {.spes = spes, .schedule = schedule, .findings = findings, .trace = trace};
  }
};

using spu_kernels::load_kernel;

/// Milliseconds of one frame, measured on the PPU thread.
struct FrameTimes {
  double physics_ms = 0;      ///< in Bullet or Box2D
  double ppu_ms = 0;          ///< in softcell, in processor time of the thread: the sum of the next four
  double gather_ms = 0;       ///< taking particles over from the engine
  double solve_ms = 0;        ///< handing the solver's work over and taking it back, or doing it
  double apply_ms = 0;        ///< giving the engine the new velocities
  double skin_ms = 0;         ///< handing over the skinning
  double solver_wait_ms = 0;  ///< by the clock, until the solver had finished; in none of the above
  double skin_wait_ms =
      0;  ///< waiting for the SPEs, so that pictures are the same on every host; in none of the above
};

}  // namespace softcell::demos
