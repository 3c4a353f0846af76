#pragma once
// Finds the face of another body through which a point has entered it.

#include <Eigen/Core>
#include <optional>

#include "ppu/contacts/contact_terms.h"

namespace softcell::ppu {

/// Finds the way out of a body, as way_out_of() does, for a point of another body that may be deep inside. If a body is pressed flat, the
/// nearest place of its surface at rest is often at its rim, because above and below there is more at rest than there is now: two bodies on
/// each other would be pushed sideways, and into each other. A point that is deep leaves through the face that the line towards the inside
/// of the point's own body meets.
/// @param along  metres: from the point to a place well inside of its own body
std::optional<WayOut> way_out_of(const ContactBody& body, const DeformedPlace& place, float allowance,
                                 const Eigen::Vector3f& along);

}  // namespace softcell::ppu
