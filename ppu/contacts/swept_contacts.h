#pragma once
// Finds contacts of two soft bodies that may pass through each other within a substep: their places at its end do not show it.

#include <Eigen/Core>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/contact_group.h"
#include "ppu/surfaces/cell_finder.h"

namespace softcell::ppu {

/// Whether two bodies would penetrate so far in the substep that they have to be swept: more than a cell, and more than three tenths of the
/// thinner one's thickness. Contacts would stop only their surfaces, and the rest would pass through, so they hit each other as rigid
/// bodies would (bounces.h), with about the restitution that slower bodies have.
bool are_fast(const ContactBody& a, const ContactBody& b);

inline constexpr float kFastRestitution = 0.3f;

/// Used by one thread; keeps its allocated memory.
class SweptContacts {
 public:
  /// Finds points of a's surface in b, as seen from a: each at the place where it is first in b, if both move straight. The motion is
  /// sampled every half cell, or in a fixed number of steps if a body is too fast for that. Appends to `contacts`.
  /// @param step  seconds
  void find(const ContactBody& a, const ContactBody& b, float step, std::vector<SoftContact>& contacts);

 private:
  CellFinder finder_;
  std::vector<Eigen::Vector3f> particles_;  // of b, at one moment
  std::vector<Eigen::Vector3f> from_, to_;  // of a's touch points
  std::vector<bool> has_met_;               // of these
};

}  // namespace softcell::ppu
