#include "ppu/lattice/skin_field.h"

#include <algorithm>
#include <cmath>

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

constexpr int kPadding = 2;  // cells around the lattice in which the field is sampled, too

/// Falls from 1 inside to 0 outside of an edge, as steeply at the edge as smoothed edges of cells.
float fall_at(float outside) {
  constexpr float kReach = 1.5f, kHalf = SkinField::kEdge;
  const float t = std::clamp(outside / kReach, -1.0f, 1.0f), square = t * t;
  return kHalf - kHalf * t * (15 - 10 * square + 3 * square * square) / 8;
}

}  // namespace

SkinField::SkinField(const CellsByIndex& cells)
    : cells_(cells),
      origin_(cells.low() - Vector2i::Constant(kPadding)),
      size_(kSamples * (cells.high() - cells.low() + Vector2i::Constant(2 * kPadding + 1)) +
            Vector2i::Ones()) {
  values_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()));
}

SkinField SkinField::of_cells(const CellsByIndex& cells, float margin) {
  SkinField field(cells);
  for (int x = 0; x < field.size_.x(); ++x) {
    for (int y = 0; y < field.size_.y(); ++y) field.value(x, y) = field.covered({x, y}, margin);
  }
  // A standard deviation of six tenths of a cell smooths any stairs. A narrow margin needs less.
  field.smooth(margin >= 0.35f ? 6 : 2);
  field.open_gaps();
  return field;
}

SkinField SkinField::of_shape(const CellsByIndex& cells, float margin, const Outside2d& outside) {
  SkinField field(cells);
  for (int x = 0; x < field.size_.x(); ++x) {
    for (int y = 0; y < field.size_.y(); ++y)
      field.value(x, y) = fall_at(outside(field.grid_position(x, y)) - margin);
  }
  return field;
}

SkinField SkinField::part(const std::vector<bool>& chosen) const {
  constexpr float kInside = 0.25f;  // this much of the shape counts: slightly more than is drawn
  constexpr float kLeast = 1e-3f;
  constexpr int kPasses = 3;  // few, so that a single cell stays visible
  SkinField in_part(*this), in_shape(*this);
  for (int x = 0; x < size_.x(); ++x) {
    for (int y = 0; y < size_.y(); ++y) {
      const bool inside = value(x, y) >= kInside;
      in_shape.value(x, y) = inside ? 1.0f : 0.0f;
      in_part.value(x, y) = inside && chosen[cells_.nearest(grid_position(x, y))] ? 1.0f : 0.0f;
    }
  }
  in_part.smooth(kPasses);
  in_shape.smooth(kPasses);
  // The mean is taken within the shape only, so that lines between parts run straight into its edge.
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const float share = in_part.values_[i] / std::max(in_shape.values_[i], kLeast);
    in_part.values_[i] = std::min(values_[i], share);
  }
  return in_part;
}

SkinField SkinField::without(const SkinField& part) const {
  SkinField rest(*this);
  for (std::size_t i = 0; i < values_.size(); ++i)
    rest.values_[i] = std::min(values_[i], 2 * kEdge - part.values_[i]);
  return rest;
}

Vector2f SkinField::slope(int x, int y) const {
  const auto clamped = [&](int i, int j) {
    return value(std::clamp(i, 0, size_.x() - 1), std::clamp(j, 0, size_.y() - 1));
  };
  return 0.5f * kSamples *
         Vector2f(clamped(x - 1, y) - clamped(x + 1, y), clamped(x, y - 1) - clamped(x, y + 1));
}

/// Whether a sample lies within the cells, wider by the margin: 1 or 0, and a value between near the edge.
float SkinField::covered(const Vector2i& sample, float margin) const {
  const Vector2f position = grid_position(sample.x(), sample.y());
  const Vector2i cell = cell_of(sample);
  float away = 2;
  bool all_around = true;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      const Vector2i other = cell + Vector2i(x, y);
      const float distance = CellsByIndex::distance(other, position);
      const bool here = cells_.has(other);
      if (here) away = std::min(away, distance);
      if (!here && distance == 0) all_around = false;
    }
  }
  return all_around ? 1 : std::clamp(0.5f + (margin - away) * kSamples, 0.0f, 1.0f);
}

void SkinField::smooth(int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    smooth_along(0);
    smooth_along(1);
  }
}

/// Replaces each sample by the binomial mean of five along `axis`: a standard deviation of one sample.
void SkinField::smooth_along(int axis) {
  const int length = size_[axis], lines = size_[1 - axis];
  const auto sample = [&](int line, int i) -> float& { return axis == 0 ? value(i, line) : value(line, i); };
  line_.assign(static_cast<std::size_t>(length) + 4, 0.0f);
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < length; ++i) line_[static_cast<std::size_t>(i) + 2] = sample(line, i);
    for (int i = 0; i < length; ++i) {
      const float* const from = line_.data() + i;
      sample(line, i) = (from[0] + from[4] + 4 * (from[1] + from[3]) + 6 * from[2]) * 0.0625f;
    }
  }
}

/// Whether a free cell lies between two cells along an axis.
bool SkinField::is_gap(const Vector2i& cell, const Vector2i& axis) const {
  return !cells_.has(cell) && cells_.has(cell - axis) && cells_.has(cell + axis);
}

/// Keeps both sides of a gap of one cell apart, however wide the margin. A notch only one cell deep is filled.
void SkinField::open_gaps() {
  constexpr float kHalfGap = 0.12f, kSteepness = 0.65f;
  for (int x = 0; x < size_.x(); ++x) {
    for (int y = 0; y < size_.y(); ++y) {
      const Vector2i cell = cell_of({x, y});
      if (cells_.has(cell)) continue;
      const Vector2f middle = grid_position(x, y) - cell.cast<float>() - Vector2f::Constant(0.5f);
      const auto keep_open = [&](const Vector2i& axis, float from_middle) {
        const Vector2i along(axis.y(), axis.x());
        const bool here = is_gap(cell, axis), before = is_gap(cell - along, axis),
                   behind = is_gap(cell + along, axis);
        // Also beyond the end of a gap: the margins of its sides would close it there.
        const bool end =
            (before && is_gap(cell - 2 * along, axis)) || (behind && is_gap(cell + 2 * along, axis));
        if ((here && (before || behind)) || end)
          value(x, y) = std::min(value(x, y), kEdge + kSteepness * (std::abs(from_middle) - kHalfGap));
      };
      keep_open({1, 0}, middle.x());
      keep_open({0, 1}, middle.y());
    }
  }
}

}  // namespace softcell::ppu
