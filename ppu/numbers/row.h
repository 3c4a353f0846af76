#pragma once
// Three numbers as a quadword.

#include <Eigen/Core>

namespace softcell::ppu {

/// Number by number. A quadword that is read right behind its four parts waits for them in the store buffer: rows are for lists that are
/// written as a whole before they are read.
inline void set_row(Eigen::Array4f& row, const Eigen::Vector3f& numbers) {
  row.head<3>() = numbers;
  row[3] = 0;
}

}  // namespace softcell::ppu
