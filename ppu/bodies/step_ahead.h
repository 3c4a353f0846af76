#pragma once
// The bodies of one world, their solver, and the step that the solver may have begun ahead of the engine.
//
//     begin(step)     the solver copies positions and velocities and works on its own, while the PPU does other things
//     finish(step)    the engine needs the step: waits for the solver, or makes it do the whole step now
//
// If a body was changed in between, drop() discards the step that was begun; finish() then begins a new one.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::ppu {

/// @tparam kDimension  2 or 3
template <int kDimension>
class StepAhead {
 public:
  using Body = SoftBody<kDimension>;
  using Solver = SoftBodySolver<kDimension>;

  explicit StepAhead(std::unique_ptr<Solver> solver) : StepAhead(*solver) { owned_ = std::move(solver); }
  /// @param solver  must outlive this object.
  explicit StepAhead(Solver& solver) : solver_(solver) {}
  ~StepAhead() { clear(); }
  StepAhead(const StepAhead&) = delete;
  StepAhead& operator=(const StepAhead&) = delete;

  /// @param body  must stay in place until it is removed.
  void add(Body& body) {
    SC_ASSERT(std::ranges::find(bodies_, &body) == bodies_.end(), "a body is added twice to {}",
              bodies_.size());
    drop();
    bodies_.push_back(&body);
  }
  void remove(const Body& body) {
    const auto found = std::ranges::find(bodies_, &body);
    SC_ASSERT(found != bodies_.end(), "a body that is none of these {}", bodies_.size());
    drop();
    solver_.forget(body);
    bodies_.erase(found);
  }
  void clear() {
    drop();
    for (const Body* const body : bodies_) solver_.forget(*body);
    bodies_.clear();
  }

  /// Tells that the body was teleported: the solver forgets its rotations. @pre No step has been begun.
  void forget(const Body& body) {
    SC_ASSERT(begun_ == 0, "a body is forgotten during its step of {} s", begun_);
    solver_.forget(body);
  }

  /// Tells that a body breaks into pieces: see SoftBodySolver::inherit_state(). @pre No step has been begun.
  void inherit_state(const Body& whole, const Body& piece, std::span<const std::uint32_t> particle_of) {
    SC_ASSERT(begun_ == 0, "a body breaks during its step of {} s", begun_);
    solver_.inherit_state(whole, piece, particle_of);
  }

  /// Call it directly after finish(): see SoftBodySolver::may_break(). @pre No step has been begun.
  bool may_break(const Body& body) const {
    SC_ASSERT(begun_ == 0, "a body is asked whether it breaks during its step of {} s", begun_);
    return solver_.may_break(body);
  }

  /// May be called by any thread.
  void prepare(const std::shared_ptr<const SoftBodyModel<kDimension>>& model) { solver_.prepare(model); }

  /// Begins a step of `step` seconds and discards one that was begun before.
  void begin(float step) {
    SC_ASSERT(step > 0, "a time step of {} s", step);
    drop();
    solver_.kick(bodies_, step);
    begun_ = step;
  }
  bool has_begun(float step) const { return begun_ == step; }

  /// Discards the step that was begun, if there is one.
  void drop() {
    if (std::exchange(begun_, 0.0f) != 0) solver_.drop();
  }

  /// Changes the velocities of all bodies that are awake, with the step that was begun or with a new one.
  /// @return how long the calling thread waited for the solver.
  std::chrono::nanoseconds finish(float step) {
    if (!has_begun(step)) begin(step);
    begun_ = 0;  // also if the solver throws
    const auto begin_of_wait = std::chrono::steady_clock::now();
    solver_.finish();
    return std::chrono::steady_clock::now() - begin_of_wait;
  }

 private:
  std::unique_ptr<Solver> owned_;  // null: the caller owns it
  Solver& solver_;
  std::vector<Body*> bodies_;
  float begun_ = 0;  // seconds; 0: none
};

}  // namespace softcell::ppu
