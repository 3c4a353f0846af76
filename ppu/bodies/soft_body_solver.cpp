#include "softcell/soft_bodies/soft_body_solver.h"

#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {

template <int kDimension>
void PpuSolver<kDimension>::kick(std::span<SoftBody<kDimension>* const> bodies, float step) {
  SC_ASSERT(bodies_.empty(), "kick() of {} bodies while a step of {} is under way", bodies.size(),
            bodies_.size());
  SC_ASSERT(step > 0 && std::isfinite(step), "a time step of {} s", step);
  SC_ASSERT(std::ranges::find(bodies, nullptr) == bodies.end(), "one of {} bodies is null", bodies.size());
  bodies_.assign(bodies.begin(), bodies.end());
  step_ = step;
}

template <int kDimension>
void PpuSolver<kDimension>::finish() {
  // Ends the step also if a body's pull() throws.
  const struct End {
    std::vector<SoftBody<kDimension>*>& bodies;
    ~End() { bodies.clear(); }
  } end{bodies_};
  for (SoftBody<kDimension>* const body : bodies_)
    if (!body->asleep()) body->pull(step_), body->flow(step_);
}

template <int kDimension>
void PpuSolver<kDimension>::drop() {
  bodies_.clear();
}

/// A SoftBody keeps its own rotations.
template <int kDimension>
void PpuSolver<kDimension>::forget(const SoftBody<kDimension>&) {
  SC_ASSERT(bodies_.empty(), "forget() while a step of {} bodies is under way", bodies_.size());
}

template class PpuSolver<2>;
template class PpuSolver<3>;

}  // namespace softcell::ppu
