#pragma once
// Edges and tips that press on few cells of a body.
//
// All of the body's weight then hangs on a row of cells. These would be crushed, and turned inside out by a fall from its own height: shape
// matching holds the row by its neighbours only. What is inside out has no inside in which others are found, so the edge would go on through
// the body. So where something is sharp a body goes on as a whole no farther than the cells behind the contact can be squeezed (bounces.h).

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/contact_group.h"
#include "ppu/surfaces/cell_finder.h"

namespace softcell::ppu {

/// Metres, along the contact's normal, until one of the cells behind the contact is squeezed as far as cells at an edge may be.
/// @param place    of the body: where it meets an edge or a tip
/// @param inwards  of unit length, by DeformedPlace::xi
/// @param depth    metres: how deep the edge would be in the body at the substep's end
float room_to_squeeze(const ContactBody& body, const DeformedPlace& place, const Eigen::Vector3f& inwards,
                      float depth);

/// Used by one thread. Allocates when a body has more contacts than ever before.
class SharpContacts {
 public:
  /// A body that lies on much else besides is not carried by an edge. Takes SoftContact::room off contacts that are not sharp.
  /// @param contacts  of the body with rigid bodies, all of them
  /// @return          whether some are
  bool keep(std::span<SoftContact> contacts, const ContactBody& body);

 private:
  std::vector<std::uint32_t> cells_;  // that contacts have
};

}  // namespace softcell::ppu
