#pragma once
// Handles edges and tips that press on few cells of a body.
//
// All of the body's weight then rests on a row of cells. A fall from the body's own height would crush them and turn them inside out: in
// shape matching only the neighbours hold the row. An inverted cell has no inside in which others are found, so the edge would pass through
// the body. So at a sharp contact a body moves on as a whole no farther than the cells behind the contact can be squeezed (bounces.h).

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
  /// Removes SoftContact::room from contacts that are not sharp. An edge does not carry a body that also lies on much else.
  /// @param contacts  all contacts of the body with rigid bodies
  /// @return          whether some are sharp
  bool keep(std::span<SoftContact> contacts, const ContactBody& body);

 private:
  std::vector<std::uint32_t> cells_;  // cells with contacts
};

}  // namespace softcell::ppu
