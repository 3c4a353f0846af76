#pragma once
// Finds the face of another body through which a point has entered it.

#include <Eigen/Core>
#include <optional>

#include "ppu/contacts/contact_terms.h"

namespace softcell::ppu {

/// As way_out_of(), for a point that may be deep at the substep's end. Contacts are not solved yet there, and a stiff body that is pressed
/// returns to its shape within a substep: its points may end in the middle of the other body, where the nearest face may be any. The point
/// leaves by the face where it gets deep. If it is deep from the beginning, it leaves by the face that is nearest then, or by the one that
/// a line to the inside of its own body meets, if that one is not much farther as the body is deformed: of a body that is pressed flat, the
/// nearest face at rest is often its rim, and two bodies on each other would be pushed sideways, and into each other.
/// @param along  metres: at the substep's beginning, from the point to a place well inside of its own body; 0: none is known
/// @param begin  the cell coordinates, in `place.cell`, of the body's place where the point is at the substep's beginning: opposite()
std::optional<WayOut> way_out_of(const ContactBody& body, const DeformedPlace& place, float allowance,
                                 const Eigen::Vector3f& along, const Eigen::Vector3f& begin);

}  // namespace softcell::ppu
