#pragma once
// Finds the cell of a deformed lattice in which a point lies.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

struct DeformedPlace {
  std::uint32_t cell = 0;
  Eigen::Vector3f xi{0, 0, 0};                             ///< 0..1 along each edge
  Eigen::Matrix3f jacobian = Eigen::Matrix3f::Identity();  ///< dx/dxi there, metres
};

/// Sorts the cells of one lattice into a grid of cubes. Allocates only when a body grows.
class CellFinder {
 public:
  /// @param positions  of the lattice's particles, metres; must stay in place while find() is used
  void place(const Lattice<3>& lattice, std::span<const Eigen::Vector3f> positions);

  /// The first cell that contains the point, of those whose numbers `wanted` accepts. Inverted cells contain no point.
  template <typename Wanted>
  std::optional<DeformedPlace> find(const Eigen::Vector3f& point, const Wanted& wanted) const {
    std::optional<DeformedPlace> found;
    for_each_box_around(point, [&](std::uint32_t cell) {
      if (wanted(cell)) found = place_in(cell, point);
      return found.has_value();
    });
    return found;
  }

  /// Whether the point lies in the box of any cell. If not, no cell contains it.
  bool may_find(const Eigen::Vector3f& point) const {
    bool is_in_box = false;
    for_each_box_around(point, [&](std::uint32_t) { return is_in_box = true; });
    return is_in_box;
  }

 private:
  struct Box {
    Eigen::Vector3f low, high;
  };

  /// Calls work(cell) for cells whose boxes contain the point, ascending, until it returns true.
  template <typename Work>
  void for_each_box_around(const Eigen::Vector3f& point, const Work& work) const {
    const Eigen::Vector3f place = (point - low_) * per_cube_;
    if (!((place.array() >= 0).all() && (place.array() < counts_.cast<float>().array()).all())) return;
    const Eigen::Vector3i cube = place.cast<int>();
    const auto index = static_cast<std::size_t>((cube.z() * counts_.y() + cube.y()) * counts_.x() + cube.x());
    for (std::uint32_t i = begin_[index]; i < begin_[index + 1]; ++i) {
      const Box& box = boxes_[cells_[i]];
      if ((point.array() < box.low.array()).any() || (point.array() > box.high.array()).any()) continue;
      if (work(cells_[i])) return;
    }
  }

  std::optional<DeformedPlace> place_in(std::uint32_t cell, const Eigen::Vector3f& point) const;

  const Lattice<3>* lattice_ = nullptr;
  std::span<const Eigen::Vector3f> positions_;
  Eigen::Vector3f low_{0, 0, 0};
  float per_cube_ = 1;
  Eigen::Vector3i counts_{0, 0, 0};
  std::vector<Eigen::Array4f> rows_;  // of each particle: its position
  std::vector<Box> boxes_;            // of each cell
  std::vector<std::uint32_t> begin_;  // of each cube
  std::vector<std::uint32_t> cells_, next_;
};

}  // namespace softcell::ppu
