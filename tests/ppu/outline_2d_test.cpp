// What bodies in two dimensions are drawn with.

#include "softcell/soft_bodies/outline_2d.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <span>

#include "ppu/lattices_2d.h"

namespace softcell::ppu {
namespace {

using namespace test;

/// Twice the area of a polygon, in cells; positive when it is counter-clockwise.
int doubled_area(const Lattice<2>& lattice, std::span<const std::uint32_t> loop) {
  int area = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2i &a = lattice.particles[loop[i]],
                          &b = lattice.particles[loop[(i + 1) % loop.size()]];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area;
}

TEST(Outline2d, LoopsEncloseTheAreaOfTheCells) {
  for (const auto& [name, lattice] : all_lattices_2d()) {
    int area = 0;
    for (const auto& loop : outline(lattice)) {
      area += doubled_area(lattice, loop);
      EXPECT_EQ(std::set(loop.begin(), loop.end()).size(), loop.size()) << name << ": a loop meets itself";
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Eigen::Vector2i side =
            lattice.particles[loop[(i + 1) % loop.size()]] - lattice.particles[loop[i]];
        EXPECT_EQ(side.cwiseAbs().sum(), 1) << name << ": a side that is no cell's";
      }
    }
    EXPECT_EQ(area, 2 * static_cast<int>(lattice.cells.size())) << name;
  }
}

TEST(Outline2d, HolesAreLoopsOfTheirOwn) {
  const auto loops = outline(lattice_of_rows({"####..", "#..#..", "######"}));
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].size(), 2u * (6 + 3));
  EXPECT_EQ(loops[1].size(), 6u);  // two cells
  EXPECT_EQ(outline(rectangle(5, 4)).size(), 1u);
  EXPECT_EQ(outline(lattice_of_rows({"#.", ".#"})).size(), 2u);
}

TEST(Outline2d, TrianglesCoverTheCells) {
  for (const auto& [name, lattice] : all_lattices_2d()) {
    const auto triangles = cell_triangles(lattice);
    ASSERT_EQ(triangles.size(), 2 * lattice.cells.size()) << name;
    for (const auto& triangle : triangles) EXPECT_EQ(doubled_area(lattice, triangle), 1) << name;
  }
}

}  // namespace
}  // namespace softcell::ppu
