#include "scene_2d.h"

#include <algorithm>

#include "softcell/base/assert.h"

namespace softcell::demos {

ppu::Lattice<2> SoftBody2dPlacement::lattice() const {
  ppu::Lattice<2> lattice = ppu::lattice_from_cells(cells, settings.cell_size);
  SC_ASSERT(!lattice.particles.empty(), "{} cells without particles", cells.size());
  Eigen::Vector2i low = lattice.particles.front(), high = low;
  for (const Eigen::Vector2i& particle : lattice.particles) {
    low = low.cwiseMin(particle);
    high = high.cwiseMax(particle);
  }
  lattice.origin = -0.5f * settings.cell_size * (low + high).cast<float>();
  return lattice;
}

Eigen::Vector2f Camera2d::point_at(int x, int y, int picture_width, int picture_height) const {
  SC_ASSERT(picture_height > 0, "a picture of {} by {} pixels", picture_width, picture_height);
  SC_ASSERT(height > 0, "a camera that shows {} m", height);
  const float metres = height / static_cast<float>(picture_height);
  const Eigen::Vector2f middle = 0.5f * Eigen::Vector2i(picture_width, picture_height).cast<float>();
  return centre +
         metres * Eigen::Vector2f(static_cast<float>(x) - middle.x(), middle.y() - static_cast<float>(y));
}

float SoftBody2dPlacement::skin_margin() const { return std::min(contact_radius, ppu::kMaxSkinMargin); }

ppu::Outside2d SoftBody2dPlacement::outside() const {
  if (!ring) return {};
  return [own = *ring](const Eigen::Vector2f& at) {
    const float away = (at - own.middle).norm();
    return own.hole > 0 ? std::max(away - own.radius, own.hole - away) : away - own.radius;
  };
}

}  // namespace softcell::demos
