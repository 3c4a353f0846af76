#pragma once
// Whoever can make solvers, for couplings to engines that need not know by whom bodies are stepped.

#include <memory>

#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::ppu {

/// SpeRuntime (spe_bodies/spe_runtime.h) is one: then SPEs step the bodies. It outlives the solvers that it
/// has made. Used by one thread at a time.
class SolverFactory {
 public:
  virtual ~SolverFactory() = default;

  /// A solver for the soft bodies of one world. @throws std::runtime_error  as the factory says.
  virtual std::unique_ptr<SoftBodySolver<3>> make_solver() = 0;
  /// In two dimensions.
  virtual std::unique_ptr<SoftBodySolver<2>> make_solver_2d() = 0;
};

}  // namespace softcell::ppu
