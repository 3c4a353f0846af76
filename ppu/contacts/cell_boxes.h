#pragma once
// Boxes around the cells of a body on their ways through a substep.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

  bool any_meets(const Bounds<3>& box) const {
    return std::any_of(fours_.begin(), fours_.end(),
                       [&](const Four& four) { return four.apart_from(box).minCoeff() <= 0; });
  }

 private:
  /// Of four cells; the last one again where there are fewer.
  struct Four {
    Eigen::Array4f low[3], high[3];

    /// Metres between the boxes along one axis; 0 or less where they have a point in common.
    Eigen::Array4f apart_from(const Bounds<3>& box) const {
      Eigen::Array4f most = (low[0] - box.high.x()).max(box.low.x() - high[0]);
      for (int d = 1; d < 3; ++d) most = most.max(low[d] - box.high[d]).max(box.low[d] - high[d]);
      return most;
    }
  };
  std::size_t cells_ = 0;
  std::vector<Four> fours_;
  std::vector<Eigen::Array4f> least_, most_;  // of each particle's two places
};

}  // namespace softcell::ppu
