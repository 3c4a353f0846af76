#pragma once
// Measures the distance of a place from the drawn edge of a body in two dimensions.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/skin_2d.h"

namespace softcell::ppu {

/// The outlines of a skin at rest, in grid coordinates. A query takes time in proportion to the segments near the place.
class OutlineDistance {
 public:
  /// @pre  the skin has outlines
  explicit OutlineDistance(const Skin2d& skin);

  /// In cells, below 0 inside: places that outlines go around more often counter-clockwise than clockwise.
  float signed_distance(const Eigen::Vector2f& at) const;

 private:
  struct Segment {
    Eigen::Vector2f from, to;
    float distance(const Eigen::Vector2f& at) const;
  };
  const std::vector<std::uint32_t>& in_square(int x, int y) const {
    return squares_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x()) +
                    static_cast<std::size_t>(x)];
  }
  float nearest(const Eigen::Vector2f& at) const;
  bool is_inside(const Eigen::Vector2f& at) const;

  std::vector<Segment> segments_;
  Eigen::Vector2i low_, size_;                       // of the squares, each as large as a cell
  std::vector<std::vector<std::uint32_t>> squares_;  // by rows of x: segments in each square
  std::vector<std::vector<std::uint32_t>> rows_;     // for each y: segments in that row
};

}  // namespace softcell::ppu
