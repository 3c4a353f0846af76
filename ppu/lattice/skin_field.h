#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "ppu/lattice/cells_by_index.h"
#include "softcell/soft_bodies/skin_2d.h"

namespace softcell::ppu {

/// A smooth function over the plane of a lattice, above kEdge inside of the drawn shape. Sampled at kSamples points per cell, in rows of y.
class SkinField {
 public:
  static constexpr float kEdge = 0.5f;
  static constexpr int kSamples = 4;  // along an edge of a cell

  /// The shape of the cells, wider by a margin. @param cells  must outlive the field
  static SkinField of_cells(const CellsByIndex& cells, float margin);
  /// A shape that the cells approximate, wider by a margin.
  static SkinField of_shape(const CellsByIndex& cells, float margin, const Outside2d& outside);
  /// The part of the shape that is nearest to some of its cells. Such a part and the part of all other cells meet in one line.
  /// @param chosen  for each cell of the lattice
  SkinField part(const std::vector<bool>& chosen) const;
  /// This part of a shape without another part.
  SkinField without(const SkinField& part) const;
  /// Takes the values of another field of the same cells.
  void take(const SkinField& other) { values_ = other.values_; }

  const Eigen::Vector2i& origin() const { return origin_; }  ///< grid index of sample (0, 0)
  const Eigen::Vector2i& size() const { return size_; }      ///< samples
  bool contains(int x, int y) const { return value(x, y) >= kEdge; }
  float at(int x, int y) const { return value(x, y); }
  /// The negative gradient, per cell: it points towards the edge.
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
  /// The cell that begins at the sample, or at the last one before it.
  Eigen::Vector2i cell_of(const Eigen::Vector2i& sample) const { return origin_ + sample / kSamples; }

  float covered(const Eigen::Vector2i& sample, float margin) const;
  void smooth(int passes);
  void smooth_along(int axis);
  bool is_gap(const Eigen::Vector2i& cell, const Eigen::Vector2i& axis) const;
  void open_gaps();

  const CellsByIndex& cells_;
  Eigen::Vector2i origin_, size_;
  std::vector<float> values_;
  std::vector<float> line_;  // scratch memory of smooth_along()
};

}  // namespace softcell::ppu
