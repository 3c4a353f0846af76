#include "ppu/surfaces/cell_boxes.h"

#include "ppu/numbers/row.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

void CellBoxes::place(const Lattice<3>& lattice, std::span<const Eigen::Vector3f> begins,
                      std::span<const Eigen::Vector3f> ends) {
  SC_ASSERT(
      begins.size() == lattice.particles.size() && ends.size() == begins.size() && !lattice.cells.empty(),
      "{} and {} places of {} particles", begins.size(), ends.size(), lattice.particles.size());
  least_.resize(begins.size());
  most_.resize(begins.size());
  longest_way_.setZero();
  for (std::size_t i = 0; i < begins.size(); ++i) {
    set_row(least_[i], begins[i].cwiseMin(ends[i]));
    set_row(most_[i], begins[i].cwiseMax(ends[i]));
    longest_way_ = longest_way_.cwiseMax((ends[i] - begins[i]).cwiseAbs());
  }
  cells_ = lattice.cells.size();
  fours_.resize((cells_ + 3) / 4);
  for (std::size_t c = 0; c < 4 * fours_.size(); ++c) {
    const auto& corners = lattice.corners[std::min(c, cells_ - 1)];
    Eigen::Array4f low = least_[corners[0]], high = most_[corners[0]];
    for (std::size_t k = 1; k < 8; ++k) {
      low = low.min(least_[corners[k]]);
      high = high.max(most_[corners[k]]);
    }
    FourBoxes& four = fours_[c / 4];
    const auto lane = static_cast<Eigen::Index>(c % 4);
    for (int d = 0; d < 3; ++d) four.low[d][lane] = low[d], four.high[d][lane] = high[d];
  }
  sixteens_.resize((fours_.size() + 3) / 4);
  for (std::size_t i = 0; i < 4 * sixteens_.size(); ++i) {
    const FourBoxes& four = fours_[std::min(i, fours_.size() - 1)];
    FourBoxes& sixteen = sixteens_[i / 4];
    const auto lane = static_cast<Eigen::Index>(i % 4);
    for (int d = 0; d < 3; ++d)
      sixteen.low[d][lane] = four.low[d].minCoeff(), sixteen.high[d][lane] = four.high[d].maxCoeff();
  }
}

}  // namespace softcell::ppu
