#pragma once
// Contacts of two soft bodies that may pass each other within a substep: where one is at its end says nothing.

#include <Eigen/Core>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/contact_group.h"
#include "ppu/surfaces/cell_finder.h"

namespace softcell::ppu {

/// Whether two bodies would go so far into each other in the substep that they have to be swept: more than a cell, and three tenths of the
/// thinner one's thickness. Their surfaces alone would be stopped, and what is behind goes on through them, so they hit each other as
/// rigid bodies would (bounces.h), with a restitution that slower ones have about.
bool are_fast(const ContactBody& a, const ContactBody& b);

inline constexpr float kFastRestitution = 0.3f;

/// Used by one thread; keeps its room.
class SweptContacts {
 public:
  /// Points of a's surface in b, as seen from a: each where it first is in b, if both go straight on. They are looked up in steps of half a
  /// cell, or of a share of the way of what is faster than that allows. Appends to `contacts`.
  /// @param step  seconds
  void find(const ContactBody& a, const ContactBody& b, float step, std::vector<SoftContact>& contacts);

 private:
  CellFinder finder_;
  std::vector<Eigen::Vector3f> particles_;  // of b, at one moment
  std::vector<Eigen::Vector3f> from_, to_;  // of a's touch points
  std::vector<bool> has_met_;               // of these
};

}  // namespace softcell::ppu
