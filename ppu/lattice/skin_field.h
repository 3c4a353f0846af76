#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ppu/lattice/cells_by_index.h"
#include "softcell/soft_bodies/skin_2d.h"

namespace softcell::ppu {

/// A smooth function over the plane of a lattice, above kEdge inside of the shape that is drawn. Sampled at kSamples
/// points a cell, in rows of y.
class SkinField {
 public:
  static constexpr float kEdge = 0.5f;
  static constexpr int kSamples = 4;  // along an edge of a cell

  /// The cells, wider by a margin. @param cells  must outlive it
  static SkinField of_cells(const CellsByIndex& cells, float margin);
  /// A shape that the cells stand for, wider by a margin.
  static SkinField of_shape(const CellsByIndex& cells, float margin, const Outside2d& outside);
  /// What of a shape is nearest to some of its cells. The same shape's parts of those cells and of all others meet in one line.
  /// @param chosen  of each cell of the lattice
  SkinField part(const std::vector<bool>& chosen) const;
  /// What of this part of a shape is not in another.
  SkinField without(const SkinField& part) const;
  /// Becomes another field of the same cells.
  void take(const SkinField& other) { values_ = other.values_; }

  const Eigen::Vector2i& origin() const { return origin_; }  ///< grid index of sample (0, 0)
  const Eigen::Vector2i& size() const { return size_; }      ///< samples
  bool contains(int x, int y) const { return value(x, y) >= kEdge; }
  float at(int x, int y) const { return value(x, y); }
  /// Against the gradient, per cell: towards the edge.
  Eigen::Vector2f slope(int x, int y) const;
  Eigen::Vector2f grid_position(int x, int y) const {
    return origin_.cast<float>() +
           Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) * (1.0f / kSamples);
  }

 private:
  explicit SkinField(const CellsByIndex& cells);

  std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y);
  }
  float& value(int x, int y) { return values_[slot(x, y)]; }
  float value(int x, int y) const { return values_[slot(x, y)]; }
  /// The cell that begins at a sample or the last one before.
  Eigen::Vector2i cell_of(const Eigen::Vector2i& sample) const { return origin_ + sample / kSamples; }

  float covered(const Eigen::Vector2i& sample, float margin) const;
  void smooth(int passes);
  void smooth_along(int axis);
  bool is_gap(const Eigen::Vector2i& cell, const Eigen::Vector2i& axis) const;
  void open_gaps();

  const CellsByIndex& cells_;
  Eigen::Vector2i origin_, size_;
  std::vector<float> values_;
  std::vector<float> line_;  // what smooth_along() works on
};

}  // namespace softcell::ppu
