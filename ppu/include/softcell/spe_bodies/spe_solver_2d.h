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
#include <map>
#include <memory>
#include <vector>

#include "ppu/spe_bodies/match_orchestrator_2d.h"
#include "softcell/soft_bodies/solver_2d.h"

namespace softcell::ppu {

/// Of one world. The result is the same bits for any number of SPEs.
class SpeSolver2d final : public Solver2d {
 public:
  /// All three outlive the solver. `match_2d` is the image of that kernel.
  SpeSolver2d(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match_2d);

  /// @throws std::runtime_error  a body needs more local store than an SPE has (some 1300 particles fit), or
  ///         main memory is full.
  void set_bodies(std::span<SoftBody2d* const> bodies) override;
  void pull(float step) override;

  /// Time that pull() has spent waiting for the SPEs so far.
  std::chrono::nanoseconds time_waited() const { return waited_; }

 private:
  struct Model {
    std::shared_ptr<const SoftBodyModel2d> model;
    MatchPlan2d plan;
    std::vector<SoftBody2d*> bodies;
  };

  void write_bodies();
  void read_bodies();

  dma::AddressSpace& memory_;
  JobSystem& jobs_;
  const ls_sim::KernelImage& match_2d_;
  std::vector<Model> models_;
  std::vector<MatchOrchestrator2d::Settings> settings_;  // of each model
  std::unique_ptr<MatchOrchestrator2d> matching_;        // none without bodies
  std::chrono::nanoseconds waited_{0};
};

}  // namespace softcell::ppu
