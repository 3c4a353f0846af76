#pragma once
// Refuses bodies whose numbers are no longer finite.

#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// @throws std::runtime_error  always; the message says that positions or velocities are not finite.
[[noreturn]] void refuse_to_be_infinite();

/// Also checks numbers that will be squared. @throws std::runtime_error  the body is not finite, or 1e15 m large or far away.
void check_finite(const ContactBody& body);

}  // namespace softcell::ppu
