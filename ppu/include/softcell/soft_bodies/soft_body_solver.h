#pragma once
// Solvers: they do the shape matching and damping of many bodies in a time step. PpuSolver works on the calling
// thread, SpeSolver (spe_bodies/spe_solver.h) on SPEs.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// The interface of solvers. One thread uses a solver. Between kick() and finish() or drop(), bodies must not
/// be moved or destroyed, and changes of their velocities are lost.
/// @tparam kDimension  2 or 3
template <int kDimension>
class SoftBodySolver {
 public:
  virtual ~SoftBodySolver() = default;

  /// Reads positions and velocities of all bodies that are awake and begins a time step of `step` seconds.
  /// @pre no step is under way; step > 0, finite; no body is null or occurs twice
  /// @throws std::runtime_error  as the solver says.
  virtual void kick(std::span<SoftBody<kDimension>* const> bodies, float step) = 0;

  /// Waits for the step that kick() has begun and changes the bodies' velocities, and the rest shapes of those that yield.
  /// @throws std::runtime_error  a particle is NaN or infinite, or an SPE failed.
  virtual void finish() = 0;

  /// Waits for the step that kick() has begun and discards its result: no body changes. The next step starts from the rotations that SPEs
  /// have found by then. If these had converged, its result is the same; otherwise it is the same within the tolerance of the iteration.
  virtual void drop() = 0;

  /// Discards what the solver knows of the body from earlier steps. Call it after the body was teleported and before it is destroyed. @pre
  /// no step is under way.
  virtual void forget(const SoftBody<kDimension>& body) = 0;

  /// Prepares for bodies of a model that will be stepped soon: makes slow data now. Any thread may call it at any time. It does not change
  /// results.
  virtual void prepare(const std::shared_ptr<const SoftBodyModel<kDimension>>& /*model*/) {}

  /// Passes what the solver knows of a body on to a piece of it. Call it for each piece, after the last step of the whole body. The piece's
  /// model must have been prepared. The solver keeps this for the first body of that model that it steps next, which need not be `piece`
  /// itself.
  /// @param whole  the body that broke   @param piece  one of its pieces
  /// @param particle_of  for each particle of the piece, its number in the whole
  /// @pre no step is under way
  virtual void inherit_state([[maybe_unused]] const SoftBody<kDimension>& whole,
                             [[maybe_unused]] const SoftBody<kDimension>& piece,
                             [[maybe_unused]] std::span<const std::uint32_t> particle_of) {}

  /// Whether a face of the body may have broken before the step that finish() ended last. Returns false only if the solver has found that
  /// no face can have broken; the caller then need not check. @pre nothing has moved the body since finish()
  virtual bool may_break(const SoftBody<kDimension>& /*body*/) const { return true; }
};

/// The reference: steps the bodies one after the other by SoftBody::pull() and flow(), in finish().
template <int kDimension>
class PpuSolver final : public SoftBodySolver<kDimension> {
 public:
  void kick(std::span<SoftBody<kDimension>* const> bodies, float step) override;
  void finish() override;
  void drop() override;
  void forget(const SoftBody<kDimension>& body) override;

 private:
  std::vector<SoftBody<kDimension>*> bodies_;
  float step_ = 0;
};

extern template class PpuSolver<2>;
extern template class PpuSolver<3>;

}  // namespace softcell::ppu
