#pragma once
// Finds where a body would enter obstacles in the coming substep.

#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/contact_group.h"
#include "ppu/contacts/end_cells.h"
#include "ppu/obstacles/obstacle.h"

namespace softcell::ppu {

/// A body, and the obstacles that it may meet.
struct ObstacleSearch {
  const ContactBody& body;
  EndCells& cells;  ///< the body's
  std::span<const Obstacle> obstacles;
  std::span<const std::uint32_t> near;  ///< indices of all obstacles near the body
  std::span<const ContactRigid> rigids;
  float step;  ///< seconds
};

/// Finds points of the body's surface, and its particles, in near obstacles, and edges of these obstacles in the body. Appends to
/// `contacts`, obstacle by obstacle.
void find_contacts(const ObstacleSearch& search, std::vector<SoftContact>& contacts);

}  // namespace softcell::ppu
