#pragma once
// Three numbers in a quadword.

#include <Eigen/Core>

namespace softcell::ppu {

/// Sets the numbers one by one. Reading a whole quadword right after its four parts were written waits for the store buffer: use rows in
/// lists that are written as a whole before they are read.
inline void set_row(Eigen::Array4f& row, const Eigen::Vector3f& numbers) {
  row.head<3>() = numbers;
  row[3] = 0;
}

}  // namespace softcell::ppu
