#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::ppu {

void PpuSolver::kick(std::span<SoftBody* const> bodies, float step) {
  bodies_.assign(bodies.begin(), bodies.end());
  step_ = step;
}

void PpuSolver::finish() {
  for (SoftBody* const body : bodies_)
    if (!body->asleep()) body->pull(step_);
  bodies_.clear();
}

}  // namespace softcell::ppu
