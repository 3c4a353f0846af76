#pragma once
// What makes solvers: an interface, so that the couplings to engines do not depend on the emulator.

#include <memory>

#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::ppu {

class ContactWorker;

/// SpeRuntime (spe_bodies/spe_runtime.h) implements it: its solvers have SPEs step the bodies. A factory
/// outlives the solvers that it has made. One thread at a time uses it.
class SolverFactory {
 public:
  virtual ~SolverFactory() = default;

  /// A solver for the soft bodies of one world. @throws std::runtime_error  as the factory says.
  virtual std::unique_ptr<SoftBodySolver<3>> make_solver() = 0;
  /// Who finds and solves contacts of what is drawn, for the soft bodies of one world. Null, as here: the
  /// thread that steps the world. @throws std::runtime_error  as the factory says.
  virtual std::shared_ptr<ContactWorker> make_contact_worker() { return nullptr; }
  /// In two dimensions.
  virtual std::unique_ptr<SoftBodySolver<2>> make_solver_2d() = 0;
};

}  // namespace softcell::ppu
