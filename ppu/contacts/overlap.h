#pragma once
// Tells whether a soft body overlaps a rigid shape, for trigger volumes.

#include <Eigen/Core>
#include <optional>
#include <span>

#include "ppu/contacts/contact_body.h"
#include "ppu/obstacles/obstacle.h"
#include "ppu/surfaces/cell_finder.h"

namespace softcell::ppu {

struct Overlap {
  /// Metres: the middle of those points of the body that were found in the shape; or a point that is in both.
  Eigen::Vector3f point{0, 0, 0};
  /// Unit length: from the shape to that point, or along the shortest way out of the shape.
  Eigen::Vector3f normal{0, 1, 0};
};

/// A place that a body, inside its drawn surface or on it, and a shape have in common. Finds sheets and wires of any thinness that pass
/// through the body, and everything that lies in it; a blunt shape that only dips into the surface is found when it is a third of a cell
/// deep. Triangles count as sheets.
/// @param positions  of the particles of the model's lattice  @param cells  of the body at these positions
std::optional<Overlap> find_overlap(std::span<const Eigen::Vector3f> positions, const ContactModel& model,
                                    const CellFinder& cells, const Obstacle& obstacle);

}  // namespace softcell::ppu
