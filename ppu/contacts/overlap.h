#pragma once
// Whether a soft body is in a rigid shape: what trigger volumes ask.

#include <Eigen/Core>
#include <optional>
#include <span>

#include "ppu/contacts/contact_body.h"
#include "ppu/surfaces/cell_finder.h"
#include "ppu/surfaces/obstacle.h"

namespace softcell::ppu {

struct Overlap {
  /// Metres: the middle of those points of the body that were found in the shape, or one of both.
  Eigen::Vector3f point{0, 0, 0};
  /// Unit length: from the shape to that point, or the shortest way out of the shape.
  Eigen::Vector3f normal{0, 1, 0};
};

/// Where the drawn surface of a body, or what is in it, and a shape have points in common. Finds a sheet or a wire of any thinness that
/// goes through the body, and all that lies in it; something blunt that only dips into the surface, when it is a third of a cell deep.
/// Triangles are sheets.
/// @param positions  of the particles of the model's lattice  @param cells  of the body as it is now
std::optional<Overlap> find_overlap(std::span<const Eigen::Vector3f> positions, const ContactModel& model,
                                    const CellFinder& cells, const Obstacle& obstacle);

}  // namespace softcell::ppu
