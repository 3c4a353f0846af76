#pragma once

#include <Eigen/Core>

namespace softcell::ppu {

/// The cross product in two dimensions: above 0 if b lies counter-clockwise of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}
inline float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace softcell::ppu
