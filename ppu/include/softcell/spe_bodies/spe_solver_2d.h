#pragma once
// Shape matching of a Box2D world's soft bodies on the SPEs.
//
//     dma::AddressSpace memory;
//     JobSystem jobs(memory, {.spes = 6}, job_loop);       // images of the kernels: spu_kernels/images.h
//     SpeSolver2d solver(memory, jobs, match_2d);
//     Box2dSoftBodies soft_bodies(world, &solver);
//
// In each step the particles of all bodies are copied to main memory, stepped there, one body to an SPE, and
// the velocities copied back.

#include <chrono>
#include <memory>
#include <span>

#include "softcell/jobs/job_system.h"
#include "softcell/soft_bodies/solver_2d.h"

namespace softcell::ppu {

/// Of one world. The result is the same bits for any number of SPEs.
class SpeSolver2d final : public Solver2d {
 public:
  /// All three outlive the solver. `match_2d` is the image of that kernel.
  SpeSolver2d(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match_2d);
  ~SpeSolver2d() override;

  /// @throws std::runtime_error  a body needs more local store than an SPE has (some 1300 particles fit), or
  ///         main memory is full.
  void set_bodies(std::span<SoftBody2d* const> bodies) override;
  void pull(float step) override;

  /// Time that pull() has spent waiting for the SPEs so far.
  std::chrono::nanoseconds time_waited() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::ppu
