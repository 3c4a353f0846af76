#pragma once
// Boxes around the cells of a body on their ways through a substep.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/surfaces/four_boxes.h"
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
    for (std::size_t g = 0; g < fours_.size(); ++g) {
      const Eigen::Array4f apart = fours_[g].apart_from(box);
      if (apart.minCoeff() > 0) continue;
      const std::size_t count = std::min<std::size_t>(4, cells_ - 4 * g);
      for (std::size_t lane = 0; lane < count; ++lane)
        if (apart[static_cast<Eigen::Index>(lane)] <= 0) work(static_cast<std::uint32_t>(4 * g + lane));
    }
  }

  /// Around one cell.
  Bounds<3> at(std::uint32_t cell) const { return fours_[cell / 4].at(static_cast<Eigen::Index>(cell % 4)); }

  bool any_meets(const Bounds<3>& box) const {
    return std::any_of(fours_.begin(), fours_.end(),
                       [&](const FourBoxes& four) { return four.apart_from(box).minCoeff() <= 0; });
  }

 private:
  std::size_t cells_ = 0;
  std::vector<FourBoxes> fours_;              // the last cell again where there are fewer
  std::vector<Eigen::Array4f> least_, most_;  // of each particle's two places
};

}  // namespace softcell::ppu
