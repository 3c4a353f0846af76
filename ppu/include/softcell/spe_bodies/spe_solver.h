#pragma once
// Shape matching and damping of soft bodies on the SPEs: in two dimensions with the kernel `match_2d`, in three with `match` and
// `match_tiles`.
//
//     SpeSolver<3> solver(memory, jobs, {match, match_tiles, &strain});   // the kernels' images
//     BulletSoftBodies soft_bodies(world, solver);
//
//     kick():    positions, velocities --> main memory    one chain of jobs: bodies of one model share a plan
//     finish():  velocities <-- main memory               when the last job has ended

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "softcell/jobs/job_system.h"
#include "softcell/soft_bodies/soft_body_solver.h"

namespace softcell::ppu {

/// The images of the kernels that step soft bodies. They must outlive the solver.
template <int kDimension>
struct MatchKernels;
/// In two dimensions.
template <>
struct MatchKernels<2> {
  const ls_sim::KernelImage& match_2d;  ///< steps bodies that fit a local store
  /// Checks whether bodies yield or break. Null: the PPU does it. Checked if `match_2d` is.
  const ls_sim::KernelImage* strain = nullptr;
};
/// In three dimensions.
template <>
struct MatchKernels<3> {
  const ls_sim::KernelImage& match;  ///< steps bodies that fit a local store
  /// Steps larger bodies, in tiles. Checked if `match` is.
  const ls_sim::KernelImage& match_tiles;
  /// Checks whether bodies yield or break. Null: the PPU does it. Checked if `match` is.
  const ls_sim::KernelImage* strain = nullptr;
};

/// Steps soft bodies on SPEs. The result has the same bits for any number of SPEs. The rotations of regions are in main memory, not in the
/// bodies: a body that is restored from a copy begins without rotations.
///
/// The rest shapes of plastic bodies flow on the PPU, in finish(). A plastic body has its own plan in main memory, which its SPE fetches
/// for this body alone. While they step bodies, SPEs also check whether bodies of 128 to some 10,000 particles yield or break; the PPU
/// looks closely at those that may.
///
/// One SPE steps a body that fits a local store, together with other bodies of its model. In three dimensions all SPEs together step a
/// larger body, in tiles. The PPU steps bodies that no SPE can step, while the SPEs step the others: in two dimensions bodies that do not
/// fit a local store; in three dimensions bodies that do not fit even in tiles, whose lattices are some hundreds of particles high (z) and
/// have wide regions.
/// @tparam kDimension  2 or 3
template <int kDimension>
class SpeSolver final : public SoftBodySolver<kDimension> {
 public:
  using Body = SoftBody<kDimension>;

  /// `memory` and `jobs` must outlive the solver.
  /// @throws std::runtime_error  main memory is full.
  SpeSolver(dma::AddressSpace& memory, JobSystem& jobs, const MatchKernels<kDimension>& kernels);
  ~SpeSolver() override;

  void kick(std::span<Body* const> bodies, float step) override;
  void finish() override;
  void drop() override;
  void forget(const Body& body) override;
  void prepare(const std::shared_ptr<const SoftBodyModel<kDimension>>& model) override;
  void inherit_state(const Body& whole, const Body& piece,
                     std::span<const std::uint32_t> particle_of) override;
  bool may_break(const Body& body) const override;

  /// How many bodies of the last kick(), awake or asleep, the PPU steps, because no SPE can. Checked kernels need a part of the local store
  /// for their checks, so the number may be larger with them.
  std::size_t bodies_on_ppu() const;

 private:
  struct Group;   // the bodies of one model
  struct Member;  // the place of a body
  struct Known;   // the layout before the present one
  struct Plans;   // of one model
  struct Place;   // of one body, prepared ahead

  bool knows(std::span<Body* const> bodies) const;
  void regroup(std::span<Body* const> bodies);
  void find_place(Group& group, Known& known);
  Plans plans_of(const std::shared_ptr<const SoftBodyModel<kDimension>>& model) const;
  Place place_for(const std::shared_ptr<const Plans>& plans) const;
  void adopt_prepared(Known& known, std::span<Body* const> bodies);
  void adopt(Member& member, Member& old);
  void upload(Member& member);
  void follow_rest(Member& member);
  void look_at(Member& member);
  void read_back(const Member& member);

  dma::AddressSpace& memory_;
  JobSystem& jobs_;
  JobImage match_, match_tiles_;    // the second in three dimensions only
  std::optional<JobImage> strain_;  // none: the PPU checks whether bodies yield or break
  bool checked_;                    // whether the kernels are checked
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<Member> members_;  // in the order of kick()
  std::vector<Body*> left_to_ppu_;
  std::mutex preparing_;         // guards prepared_
  std::vector<Place> prepared_;  // that no group has taken yet
  float step_ = 0;
  bool is_stepping_ = false;  // between kick() and finish() or drop()
  JobChain chain_;            // last member: the chain ends before its jobs' memory is freed
};

}  // namespace softcell::ppu
