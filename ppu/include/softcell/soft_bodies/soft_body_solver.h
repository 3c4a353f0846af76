#pragma once
// Who does shape matching and damping of many bodies in a time step: the PPU, or SPEs (spe_solver.h).

#include <span>
#include <vector>

#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// Used by one thread. Between kick() and finish() or drop() the bodies must stay where they are; what is
/// done to their particles then is lost.
/// @tparam kDimension  2 or 3
template <int kDimension>
class SoftBodySolver {
 public:
  virtual ~SoftBodySolver() = default;

  /// Takes over positions and velocities of all bodies that are awake and begins a time step of `step`
  /// seconds. @pre nothing has begun. @throws std::runtime_error  as the solver says.
  virtual void kick(std::span<SoftBody<kDimension>* const> bodies, float step) = 0;

  /// Waits for what kick() has begun and changes the bodies' velocities.
  /// @throws std::runtime_error  a particle is NaN or infinite, or an SPE failed.
  virtual void finish() = 0;

  /// Waits for what kick() has begun and changes no body. SPEs may have found rotations by then, from which
  /// those of the next step start: it has the same result where they had converged, else one within the
  /// tolerance of that iteration.
  virtual void drop() = 0;

  /// What is known of the body from earlier steps is of no use any more: it was teleported, or goes.
  /// @pre nothing has begun.
  virtual void forget(const SoftBody<kDimension>& body) = 0;
};

/// Bodies one after the other, by SoftBody::pull(): the reference. Works in finish().
template <int kDimension>
class PpuSolver final : public SoftBodySolver<kDimension> {
 public:
  void kick(std::span<SoftBody<kDimension>* const> bodies, float step) override {
    bodies_.assign(bodies.begin(), bodies.end());
    step_ = step;
  }
  void finish() override {
    for (SoftBody<kDimension>* const body : bodies_)
      if (!body->asleep()) body->pull(step_);
    bodies_.clear();
  }
  void drop() override { bodies_.clear(); }
  void forget(const SoftBody<kDimension>&) override {}  // a SoftBody keeps what it needs itself

 private:
  std::vector<SoftBody<kDimension>*> bodies_;
  float step_ = 0;
};

}  // namespace softcell::ppu
