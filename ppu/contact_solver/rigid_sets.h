#pragma once
// Groups the rigid bodies of a substep that impulses move into sets for a ContactWorker, so that soft bodies which touch rigid bodies of
// different sets can be solved at the same time.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "contact_solve_job.h"
#include "ppu/contact_solver/contact_worker.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/obstacles/contact_rigid.h"

namespace softcell::ppu {

/// Used by one thread: call begin(), join() as often as needed, arrange(), and then the other functions. Allocates when there are more
/// rigid bodies than ever before.
class RigidSets {
 public:
  static constexpr std::uint32_t kNone = ~0u;
  /// The most members of a set, besides the one that nothing moves.
  static constexpr std::uint32_t kMost = spu::kSolveMaxRigids - 1;

  /// @param rigids  must stay in place until the last call
  void begin(std::span<ContactRigid> rigids);
  /// One soft body touches or is attached to both; they may be the same. @pre impulses move both
  void join(std::uint32_t rigid, std::uint32_t other);
  /// Places all bodies named by join() in the worker's memory, except for sets of more than kMost.
  void arrange(ContactWorker& worker);

  std::uint32_t sets() const { return static_cast<std::uint32_t>(sets_.size()); }
  /// kNone: join() has not named the rigid body, or its set is too large.
  std::uint32_t set_of(std::uint32_t rigid) const { return set_of_[rigid]; }
  /// The number of a rigid body in its set. A body that nothing moves has the last number in any set.
  std::uint16_t number_in(std::uint32_t set, std::uint32_t rigid) const;
  /// A set in the worker's memory.
  std::span<spu::SolveRigid> of(std::uint32_t set) const;

  /// Copies the present velocities to the worker.
  void put() const;
  /// Copies the velocities back from the worker.
  void take() const;

 private:
  /// A range of `members_`; in the worker's memory one that nothing moves follows.
  struct Set {
    std::uint32_t first = 0, count = 0;
  };
  struct Member {
    std::uint32_t rigid = 0;
    Eigen::Vector3f velocity, spin;  // at arrange()
    spu::SolveRigid* solved = nullptr;
  };
  std::span<ContactRigid> rigids_;
  DisjointSets together_;
  std::vector<bool> named_;                        // of each rigid body
  std::vector<std::uint32_t> set_of_, number_in_;  // likewise
  std::vector<Set> sets_;
  std::vector<Member> members_;
  std::span<spu::SolveRigid> solved_;
};

}  // namespace softcell::ppu
