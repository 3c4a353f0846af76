#pragma once
// In which cell of a deformed lattice a point lies.

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

/// The cells of one lattice in a grid of cubes. Allocates only when a body grows.
class CellFinder {
 public:
  /// @param positions  of the lattice's particles, metres; must stay where they are while find() is used
  void place(const Lattice<3>& lattice, std::span<const Eigen::Vector3f> positions);

  /// The first cell that holds the point, of those that `wanted` accepts by their numbers. Cells turned inside
  /// out hold nothing.
  template <typename Wanted>
  std::optional<DeformedPlace> find(const Eigen::Vector3f& point, const Wanted& wanted) const {
    const Eigen::Vector3f place = (point - low_) * per_cube_;
    if (!((place.array() >= 0).all() && (place.array() < counts_.cast<float>().array()).all())) return {};
    const Eigen::Vector3i cube = place.cast<int>();
    const auto index = static_cast<std::size_t>((cube.z() * counts_.y() + cube.y()) * counts_.x() + cube.x());
    for (std::uint32_t i = begin_[index]; i < begin_[index + 1]; ++i) {
      const Box& box = boxes_[cells_[i]];
      if ((point.array() < box.low.array()).any() || (point.array() > box.high.array()).any()) continue;
      if (!wanted(cells_[i])) continue;
      if (auto found = place_in(cells_[i], point)) return found;
    }
    return {};
  }

  /// Calls work(cell) for each cell whose box has a point in common with `box`: for some of them several times.
  template <typename Work>
  void for_each_cell_near(const Bounds<3>& box, const Work& work) const {
    const auto cube_of = [&](const Eigen::Vector3f& point) -> Eigen::Vector3i {
      const Eigen::Vector3f last = (counts_.array() - 1).matrix().cast<float>();
      return ((point - low_) * per_cube_)
          .cwiseMax(-1.0f)
          .cwiseMin(last + Eigen::Vector3f::Ones())
          .array()
          .floor()
          .cast<int>();
    };
    const Eigen::Vector3i first = cube_of(box.low).cwiseMax(0);
    const Eigen::Vector3i last = cube_of(box.high).cwiseMin((counts_.array() - 1).matrix());
    for (int z = first.z(); z <= last.z(); ++z)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int x = first.x(); x <= last.x(); ++x) {
          const auto index = static_cast<std::size_t>((z * counts_.y() + y) * counts_.x() + x);
          for (std::uint32_t i = begin_[index]; i < begin_[index + 1]; ++i) {
            const Box& cell = boxes_[cells_[i]];
            if ((box.low.array() <= cell.high.array()).all() && (cell.low.array() <= box.high.array()).all())
              work(cells_[i]);
          }
        }
  }

 private:
  struct Box {
    Eigen::Vector3f low, high;
  };
  std::optional<DeformedPlace> place_in(std::uint32_t cell, const Eigen::Vector3f& point) const;

  const Lattice<3>* lattice_ = nullptr;
  std::span<const Eigen::Vector3f> positions_;
  Eigen::Vector3f low_{0, 0, 0};
  float per_cube_ = 1;
  Eigen::Vector3i counts_{0, 0, 0};
  std::vector<Box> boxes_;            // of each cell
  std::vector<std::uint32_t> begin_;  // of each cube
  std::vector<std::uint32_t> cells_, next_;
};

}  // namespace softcell::ppu
