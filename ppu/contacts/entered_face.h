#pragma once
// By which face of another body a point has come in.

#include <Eigen/Core>
#include <optional>

#include "ppu/contacts/contact_terms.h"

namespace softcell::ppu {

/// As way_out_of(), of a point of another body. Of what is deep in a body that is pressed flat the nearest place of the surface at rest is
/// often at its rim, as above and below there is more at rest than there is now: two bodies on each other would be pushed sideways, and into
/// each other. What is deep leaves by the face that the way towards the inside of the point's own body meets.
/// @param along  metres: from the point to a place well inside of its own body
std::optional<WayOut> way_out_of(const ContactBody& body, const DeformedPlace& place, float allowance,
                                 const Eigen::Vector3f& along);

}  // namespace softcell::ppu
