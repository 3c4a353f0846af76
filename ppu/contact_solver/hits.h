#pragma once
// Chooses the contacts that are hits, which bounce (bounces.h). Two bodies that pressed on each other in the last substep do not hit each
// other, because their relative motion is deformation.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contact_solver/bounces.h"
#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/obstacles/contact_rigid.h"

namespace softcell::ppu {

/// Used by one thread; keeps allocated memory.
class Hits {
 public:
  /// Adds hits, and contacts with sharp things, whether found by the worker or by this thread.
  void add_to(Bounces& bounces, std::span<const ContactGroup> groups, std::span<const ContactBody> bodies,
              std::span<const ContactRigid> rigids, const BounceSettings& settings, float step) const;

  /// Remembers who presses on whom for the next substep.
  void remember_who_presses(std::span<const ContactGroup> groups, std::span<const ContactBody> bodies,
                            std::span<const ContactRigid> rigids, const BounceSettings& settings);
  /// Call it when bodies get other numbers.
  void forget_who_presses() { pressed_.clear(); }

 private:
  /// Body a; body b or the number of the rigid body; whether it is a rigid one.
  using Pair = std::array<std::uint32_t, 3>;
  std::vector<Pair> pressed_;  // in the last substep, ascending
};

}  // namespace softcell::ppu
