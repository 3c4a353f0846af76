#pragma once
// Boxes around the cells of a body that cover the cells' motion during a substep.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/mesh/four_boxes.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Allocates only when a body grows.
class CellBoxes {
 public:
  /// @param begins, ends  places of the lattice's particles, metres
  void place(const Lattice<3>& lattice, std::span<const Eigen::Vector3f> begins,
             std::span<const Eigen::Vector3f> ends);

  /// Calls work(cell) for each cell whose box has a point in common with `box`, ascending.
  template <typename Work>
  void for_each_meeting(const Bounds<3>& box, const Work& work) const {
    any_four_meets(box, [&](std::size_t g, const Eigen::Array4f& apart) {
      const std::size_t count = std::min<std::size_t>(4, cells_ - 4 * g);
      for (std::size_t lane = 0; lane < count; ++lane)
        if (apart[static_cast<Eigen::Index>(lane)] <= 0) work(static_cast<std::uint32_t>(4 * g + lane));
      return false;
    });
  }

  /// How far any particle moves at most, in metres along each axis.
  Eigen::Vector3f longest_way() const { return longest_way_; }

  /// The box around one cell.
  Bounds<3> at(std::uint32_t cell) const { return fours_[cell / 4].at(static_cast<Eigen::Index>(cell % 4)); }

  bool any_meets(const Bounds<3>& box) const {
    return any_four_meets(box, [](std::size_t, const Eigen::Array4f&) { return true; });
  }

 private:
  /// Calls work(index, apart) for each of fours_ that has a point in common with `box`, ascending, until it returns true.
  template <typename Work>
  bool any_four_meets(const Bounds<3>& box, const Work& work) const {
    for (std::size_t s = 0; s < sixteens_.size(); ++s) {
      const Eigen::Array4f around = sixteens_[s].apart_from(box);
      if (around.minCoeff() > 0) continue;
      const std::size_t count = std::min<std::size_t>(4, fours_.size() - 4 * s);
      for (std::size_t i = 0; i < count; ++i) {
        if (around[static_cast<Eigen::Index>(i)] > 0) continue;
        const Eigen::Array4f apart = fours_[4 * s + i].apart_from(box);
        if (apart.minCoeff() <= 0 && work(4 * s + i, apart)) return true;
      }
    }
    return false;
  }

  std::size_t cells_ = 0;
  Eigen::Vector3f longest_way_{0, 0, 0};
  std::vector<FourBoxes> fours_;              // a lane per cell; filled up with the last cell
  std::vector<FourBoxes> sixteens_;           // a lane per element of fours_; likewise
  std::vector<Eigen::Array4f> least_, most_;  // of each particle: componentwise, of its begin and end
};

}  // namespace softcell::ppu
