#pragma once
// Finds the particles of a patch of a soft body.

#include "ppu/attachments/attachment_rows.h"
#include "ppu/contacts/contact_body.h"
#include "softcell/soft_bodies/attachment.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// Uses the body's present positions.
/// @throws std::invalid_argument  not exactly one of particles, cells and a radius is given; a number that the body does not have; nothing
/// within the radius. The message says what there is.
PatchParticles<3> particles_of(const Patch<3>& patch, const SoftBody<3>& body, const ContactModel& contact);
PatchParticles<2> particles_of(const Patch<2>& patch, const SoftBody<2>& body);

}  // namespace softcell::ppu
