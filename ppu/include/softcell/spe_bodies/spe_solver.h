#pragma once
// Shape matching and damping of soft bodies on the SPEs, by the kernels `match` and `match_tiles`.
//
//     SpeSolver solver(memory, jobs, match, match_tiles);   // the kernels' images
//     BulletSoftBodies soft_bodies(world, solver);
//
//     kick():    positions, velocities --> main memory    one chain of jobs: bodies of one model share a plan
//     finish():  velocities <-- main memory               when the last job has ended

#include <memory>
#include <vector>

#include "softcell/jobs/job_system.h"
#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::ppu {

/// The result is the same bits for any number of SPEs. The rotations of regions live in main memory, not in
/// the bodies: a body restored from a copy starts without any.
///
/// A body that fits a local store is stepped whole by one SPE, with others of its model; a larger one in
/// tiles by all of them. What does not even fit in tiles, a lattice some hundreds of particles high (z) with
/// wide regions, the PPU steps while the SPEs step the others.
class SpeSolver final : public SoftBodySolver {
 public:
  /// All four must outlive the solver.
  SpeSolver(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match,
            const ls_sim::KernelImage& match_tiles);
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
  void find_place(Group& group);
  Member* known_as(const Member& member);
  void take_over(Member& member, Member& old);
  void hand_over(Member& member);
  void take_back(const Member& member);

  dma::AddressSpace& memory_;
  JobSystem& jobs_;
  JobImage match_, match_tiles_;
  bool checked_;  // the kernels' flavour
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<Member> members_;  // in the order of kick()
  std::vector<SoftBody*> left_to_ppu_;
  float step_ = 0;
  std::unique_ptr<JobChain> chain_;  // last, so that it has ended before what its jobs work on goes
};

}  // namespace softcell::ppu
