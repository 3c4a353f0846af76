#pragma once

#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/spe_options.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::demos {

/// How a scene is simulated; none of it changes the result.
struct SimulationOptions {
  int spes = 6;
  dma::Schedule schedule{};
  ls_sim::Findings* findings = nullptr;  ///< where checked kernels report; null: kernels are not checked
  ls_sim::Trace* trace = nullptr;        ///< of at least as many SPEs; null: nothing is recorded
};

/// Milliseconds of one frame, measured on the PPU thread.
struct FrameTimes {
  double physics_ms = 0;  ///< in Bullet or Box2D
  double ppu_ms = 0;      ///< in softcell: shape matching, coupling, handing over the skinning
  double skin_ms = 0;     ///< of ppu_ms: handing over the skinning, in processor time of the thread
  double skin_wait_ms =
      0;  ///< waiting for the SPEs, so that pictures are the same on every host; in none of the above
};

}  // namespace softcell::demos
