#pragma once
// Contacts of a body with the triangles of a mesh or a height field, which have no inside: on which side the body is, it remembers.

#include <cstdint>
#include <vector>

#include "ppu/contacts/obstacle_contacts.h"

namespace softcell::ppu {

/// @param obstacle  index of an obstacle of triangles in search.obstacles
void find_triangle_contacts(const ObstacleSearch& search, std::uint32_t obstacle,
                            std::vector<SoftContact>& contacts);

}  // namespace softcell::ppu
