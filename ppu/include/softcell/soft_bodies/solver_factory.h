#pragma once
// The interface of objects that make solvers. With it, the couplings to engines do not depend on the emulator.

#include <memory>

#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::ppu {

class ContactWorker;

/// SpeRuntime (spe_bodies/spe_runtime.h) implements it: with its solvers the SPEs step the bodies. A factory must outlive the solvers that
/// it has made. One thread at a time uses it.
class SolverFactory {
 public:
  virtual ~SolverFactory() = default;

  /// A solver for the soft bodies of one world. @throws std::runtime_error  as the factory says.
  virtual std::unique_ptr<SoftBodySolver<3>> make_solver() = 0;
  /// Makes a worker that finds and solves contacts of drawn surfaces, for the soft bodies of one world. Null, the default: the thread that
  /// steps the world does it. @throws std::runtime_error  as the factory says.
  virtual std::shared_ptr<ContactWorker> make_contact_worker() { return nullptr; }
  /// A solver for the soft bodies of one world of two dimensions. @throws std::runtime_error  as the factory says.
  virtual std::unique_ptr<SoftBodySolver<2>> make_solver_2d() = 0;
};

}  // namespace softcell::ppu
