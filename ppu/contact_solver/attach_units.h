#pragma once
// Groups the attachments of a substep for a ContactWorker into units. Units share no soft body and no rigid body, so they can be solved at
// the same time.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/attachments/attach_unit.h"
#include "ppu/attachments/attachments.h"
#include "ppu/contact_solver/rigid_sets.h"
#include "ppu/numbers/disjoint_sets.h"

namespace softcell::ppu {

/// Used by one thread, in the order begin(), write(), read(). Allocates when there are more attachments than ever before.
class AttachUnits {
 public:
  /// Joins rigid bodies that one attachment moves together.
  static void begin(const AttachmentSolver<3>& attachments, RigidSets& sets);
  /// @param bodies, rigids  how many there are   @param sets  already arranged
  /// @return  false: the kernel cannot solve all attachments; then there is no unit.
  bool write(const AttachmentSolver<3>& attachments, std::size_t bodies, std::size_t rigids,
             const RigidSets& sets);
  /// Reads back what the worker has computed for units().
  void read(AttachmentSolver<3>& attachments) const;

  std::span<AttachUnit> units() { return std::span(units_).first(count_); }
  std::span<const AttachUnit> units() const { return std::span(units_).first(count_); }
  /// Whether a unit holds particles of the body.
  bool hold(std::uint32_t body) const { return count_ != 0 && is_held_[body]; }
  void clear() { count_ = 0; }

 private:
  void put_in_order(const AttachmentSolver<3>& attachments, std::size_t bodies, std::size_t rigids);
  void begin_unit(std::size_t first);
  bool append(std::span<const std::uint32_t> together, const AttachmentSolver<3>& attachments,
              const RigidSets& sets);
  void give_slots(AttachUnit& unit);

  DisjointSets together_;  // of soft bodies, then of rigid ones
  std::vector<std::uint32_t> order_,
      first_;                  // attachments that belong together one after the other; where each list begins
  std::vector<bool> is_held_;  // of each body
  std::vector<AttachUnit> units_;
  std::vector<std::size_t> begins_;  // of each unit: index of its first attachment in order_
  std::size_t count_ = 0;            // of units in use
  /// A particle of a record that has no slot yet.
  struct HeldParticle {
    std::uint32_t body = 0, particle = 0, record = 0;
    bool is_entry = false;  // of an entry; else of a point
  };
  std::vector<HeldParticle> held_;
};

}  // namespace softcell::ppu
