#pragma once
// Finds sheets: triangles that are joined side by side, so that a body is in front of all of them or behind all of them.
//
//      \_____           ___|___    a wall that stands on a side of two triangles of the floor, or within one of them, is a sheet of
//       one sheet        two       its own

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/obstacles/exact_point.h"

namespace softcell::ppu {

/// Allocates only when there are more triangles than ever before.
class TriangleSheets {
 public:
  /// Two triangles are joined by a side that no third one has, and along which they are wound alike.
  void find(std::span<const std::array<Eigen::Vector3f, 3>> triangles);

  /// Number of sheets.
  std::size_t count() const { return count_; }
  /// The sheet of a triangle, below count(): numbered in the order of the triangles.
  std::uint32_t of(std::size_t triangle) const { return sheets_[triangle]; }

 private:
  struct Side {
    ExactPoint low, high;
    std::uint32_t triangle;
    bool runs_up;  // in its triangle it runs from low to high

    bool joins(const Side& other) const { return low == other.low && high == other.high; }
  };
  std::uint32_t root_of(std::uint32_t triangle);

  std::vector<Side> sides_;
  std::vector<std::uint32_t> parents_, sheets_;
  std::size_t count_ = 0;
};

}  // namespace softcell::ppu
