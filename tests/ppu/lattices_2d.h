#pragma once
// Small lattices in two dimensions, of every awkward kind.

#include <string>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu::test {

struct NamedLattice2d {
  std::string name;
  Lattice<2> lattice;
};

/// 0.1 m to a cell.
inline Lattice<2> lattice_of_rows(const std::vector<std::string>& rows) {
  return lattice_from_cells(cells_from_rows(rows), 0.1f, {-0.2f, 0.3f});
}

inline Lattice<2> rectangle(std::size_t columns, std::size_t rows) {
  return lattice_of_rows(std::vector<std::string>(rows, std::string(columns, '#')));
}

/// The man of the 2D demo.
inline Lattice<2> man132() {
  std::vector<std::string> rows(4, "      ####");
  rows.push_back("       ##");
  rows.insert(rows.end(), 2, "################");
  rows.insert(rows.end(), 2, "     ######");
  rows.insert(rows.end(), 7, "     ##  ##");
  return lattice_of_rows(rows);
}

inline std::vector<NamedLattice2d> all_lattices_2d() {
  return {
      {"block", rectangle(5, 4)},
      {"long block", rectangle(40, 3)},
      {"hole", lattice_of_rows({"####..", "#..#..", "######"})},
      {"horseshoe", lattice_of_rows({"######", "#.....", "######"})},
      {"bar", rectangle(9, 1)},
      {"column", rectangle(1, 9)},
      {"disconnected", lattice_of_rows({"##..###", "##..###"})},
      {"touching at a corner", lattice_of_rows({"#.", ".#"})},
      {"one cell", rectangle(1, 1)},
      {"man", man132()},
  };
}

}  // namespace softcell::ppu::test
