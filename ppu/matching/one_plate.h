#pragma once
// Converts a lattice in two dimensions to the form that SumPlan takes.

#include <Eigen/Core>
#include <vector>

namespace softcell::ppu {

/// All x are equal, so a plate is a whole region and a bar is one of its columns: two levels of sums.
inline std::vector<Eigen::Vector3i> as_one_plate(const std::vector<Eigen::Vector2i>& particles) {
  std::vector<Eigen::Vector3i> grid;
  grid.reserve(particles.size());
  for (const Eigen::Vector2i& p : particles) grid.push_back({0, p.x(), p.y()});
  return grid;
}

}  // namespace softcell::ppu
