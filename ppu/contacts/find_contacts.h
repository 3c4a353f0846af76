#pragma once
// Finds where bodies would enter each other or themselves in the coming substep. obstacle_contacts.h does it for obstacles.

#include <vector>

#include "ppu/contacts/contact_group.h"
#include "ppu/contacts/end_cells.h"

namespace softcell::ppu {

/// Finds points of a's surface in b. Appends to `contacts`, as seen from a.
/// @param cells_of_a, cells_of_b  the bodies'
void find_contacts(const ContactBody& a, EndCells& cells_of_a, const ContactBody& b, EndCells& cells_of_b,
                   float step, std::vector<SoftContact>& contacts);

/// Whether a body may touch itself. If not, there is no need to look for such contacts.
bool may_touch_itself(const ContactBody& body);

}  // namespace softcell::ppu
