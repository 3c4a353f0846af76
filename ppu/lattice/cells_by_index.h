#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// The cells of a lattice in two dimensions by their grid index.
class CellsByIndex {
 public:
  using Vector2i = Eigen::Vector2i;
  using Vector2f = Eigen::Vector2f;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// @param lattice  must outlive this object  @pre  it has cells
  explicit CellsByIndex(const Lattice<2>& lattice) : lattice_(lattice) {
    SC_ASSERT(!lattice.cells.empty(), "a lattice of {} particles has no cells", lattice.particles.size());
    low_ = high_ = lattice.cells.front();
    for (const Vector2i& cell : lattice.cells) {
      low_ = low_.cwiseMin(cell);
      high_ = high_.cwiseMax(cell);
    }
    const Vector2i size = high_ - low_ + Vector2i::Ones();
    numbers_.resize(static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()), kNone);
    for (std::uint32_t i = 0; i < lattice.cells.size(); ++i) numbers_[slot(lattice.cells[i])] = i;
  }

  const Vector2i& low() const { return low_; }    ///< the lowest index of a cell
  const Vector2i& high() const { return high_; }  ///< the highest

  /// The cell's number, or kNone.
  std::uint32_t number(const Vector2i& cell) const {
    if ((cell.array() < low_.array()).any() || (cell.array() > high_.array()).any()) return kNone;
    return numbers_[slot(cell)];
  }
  bool has(const Vector2i& cell) const { return number(cell) != kNone; }

  /// How far a point, in grid coordinates, is from a cell.
  static float distance(const Vector2i& cell, const Vector2f& at) {
    const Vector2f low = cell.cast<float>();
    return (low - at).cwiseMax(at - low - Vector2f::Ones()).cwiseMax(Vector2f::Zero()).norm();
  }

  /// The number of the cell that is nearest to the point; the lowest number of several equally near ones.
  std::uint32_t nearest(const Vector2f& at) const {
    const Vector2i around = at.array().floor().matrix().cast<int>();
    std::uint32_t found = kNone;
    float least = 1;  // cells at this distance may lie beyond those that are tried first
    const auto consider = [&](std::uint32_t cell) {
      const float away = distance(lattice_.cells[cell], at);
      if (away < least || (away == least && cell < found)) {
        least = away;
        found = cell;
      }
    };
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        if (const std::uint32_t cell = number(around + Vector2i(x, y)); cell != kNone) consider(cell);
      }
    }
    if (found != kNone) return found;
    least = std::numeric_limits<float>::infinity();
    for (std::uint32_t cell = 0; cell < lattice_.cells.size(); ++cell) consider(cell);
    return found;
  }

 private:
  std::size_t slot(const Vector2i& cell) const {
    const Vector2i from_low = cell - low_;
    const auto height = static_cast<std::size_t>(high_.y() - low_.y() + 1);
    return static_cast<std::size_t>(from_low.x()) * height + static_cast<std::size_t>(from_low.y());
  }

  const Lattice<2>& lattice_;
  Vector2i low_, high_;
  std::vector<std::uint32_t> numbers_;
};

}  // namespace softcell::ppu
