#pragma once
// Four boxes side by side, compared with one box at a time.

#include <Eigen/Core>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

struct FourBoxes {
  Eigen::Array4f low[3], high[3];  ///< by axis, one lane per box

  void set(Eigen::Index lane, const Eigen::Vector3f& lowest, const Eigen::Vector3f& highest) {
    for (int d = 0; d < 3; ++d) low[d][lane] = lowest[d], high[d][lane] = highest[d];
  }
  Bounds<3> at(Eigen::Index lane) const {
    return {{low[0][lane], low[1][lane], low[2][lane]}, {high[0][lane], high[1][lane], high[2][lane]}};
  }
  /// For each of the four: metres between it and `box` along one axis; 0 or less if they have a point in common.
  Eigen::Array4f apart_from(const Bounds<3>& box) const {
    Eigen::Array4f most = (low[0] - box.high.x()).max(box.low.x() - high[0]);
    for (int d = 1; d < 3; ++d) most = most.max(low[d] - box.high[d]).max(box.low[d] - high[d]);
    return most;
  }
};

}  // namespace softcell::ppu
