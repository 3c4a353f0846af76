#include "scene_2d.h"

namespace softcell::demos {

ppu::Lattice2d SoftBody2dPlacement::lattice() const {
  ppu::Lattice2d lattice = ppu::lattice_2d_from_cells(cells, settings.cell_size);
  Eigen::Vector2i low = lattice.particles.front(), high = low;
  for (const Eigen::Vector2i& particle : lattice.particles) {
    low = low.cwiseMin(particle);
    high = high.cwiseMax(particle);
  }
  lattice.origin = -0.5f * settings.cell_size * (low + high).cast<float>();
  return lattice;
}

}  // namespace softcell::demos
