#pragma once
// What soft bodies press on rigid ones, for those that lie on something (supports.h).

#include <span>
#include <vector>

#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/obstacles/contact_rigid.h"
#include "ppu/supports/supported_set.h"

namespace softcell::ppu {

/// Used by one thread; keeps allocated memory.
class Presses {
 public:
  void clear() { presses_.clear(); }
  /// Adds the contacts of a group with rigid bodies that impulses move.
  void add(const ContactGroup& group, const ContactBody& body, std::span<const ContactRigid> rigids);

  std::span<const Press> all() const { return presses_; }

 private:
  std::vector<Press> presses_;
  std::vector<float> moved_by_all_;  // of each pressing particle, by an impulse of 1 at each point
};

}  // namespace softcell::ppu
