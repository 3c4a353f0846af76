#pragma once
// Shape matching and damping of soft bodies on the SPEs, by the kernel `match`.
//
//     SpeSolver solver(memory, jobs, image);            // image of the kernel match
//     BulletSoftBodies soft_bodies(world, solver);
//
//     kick():    positions, velocities --> main memory    one chain of jobs: bodies of one model share a plan
//     finish():  velocities <-- main memory               when the last job has ended

#include <memory>
#include <vector>

#include "softcell/ppu/match_bodies.h"
#include "softcell/ppu/soft_body_solver.h"

namespace softcell::ppu {

/// The result is the same bits for any number of SPEs. Its rotations live in main memory, not in the bodies:
/// SoftBody::matcher() says nothing, and a body restored from a copy starts from the rotations of the last
/// step.
///
/// Bodies that are too large for a local store are stepped by the PPU, while the SPEs step the others.
class SpeSolver final : public SoftBodySolver {
 public:
  /// All three must outlive the solver.
  SpeSolver(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match);
  ~SpeSolver() override;

  void kick(std::span<SoftBody* const> bodies, float step) override;
  void finish() override;
  void drop() override;
  void forget(const SoftBody& body) override;

 private:
  struct Group;   // the bodies of one model
  struct Member;  // where a body is

  bool knows(std::span<SoftBody* const> bodies) const;
  void regroup(std::span<SoftBody* const> bodies);

  dma::AddressSpace& memory_;
  JobSystem& jobs_;
  JobImage match_;
  std::uint32_t arena_bytes_;  ///< of that flavour of the kernel
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<Member> members_;  // in the order of kick()
  std::vector<SoftBody*> large_;
  float step_ = 0;
  std::unique_ptr<JobChain> chain_;  // last, so that it has ended before what its jobs work on goes
};

}  // namespace softcell::ppu
