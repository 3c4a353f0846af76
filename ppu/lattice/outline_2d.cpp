#include "softcell/soft_bodies/outline_2d.h"

#include <algorithm>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// A side from one corner of a cell to the next, with the cell on its left.
struct Side {
  std::uint32_t from, to;
  auto operator<=>(const Side&) const = default;
};

/// The sides that have a cell on their left only, sorted.
std::vector<Side> boundary(const Lattice<2>& lattice) {
  std::vector<Side> sides;
  for (const auto& corner : lattice.corners) {
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 3}, {3, 2}, {2, 0}})
      sides.push_back({corner[static_cast<std::size_t>(a)], corner[static_cast<std::size_t>(b)]});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<Side> single;
  for (const Side& side : sides) {
    if (!std::binary_search(sides.begin(), sides.end(), Side{side.to, side.from})) single.push_back(side);
  }
  return single;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> cell_triangles(const Lattice<2>& lattice) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(2 * lattice.corners.size());
  for (const auto& corner : lattice.corners) {
    triangles.push_back({corner[0], corner[1], corner[3]});
    triangles.push_back({corner[0], corner[3], corner[2]});
  }
  return triangles;
}

std::vector<std::vector<std::uint32_t>> outline(const Lattice<2>& lattice) {
  const std::vector<Side> sides = boundary(lattice);
  std::vector<bool> used(sides.size());
  /// The side that begins where `side` ends. If there are two, the one that turns left, around the same cell.
  const auto next = [&](const Side& side) {
    const auto first = std::lower_bound(sides.begin(), sides.end(), Side{side.to, 0});
    SC_ASSERT(first != sides.end() && first->from == side.to, "a boundary ends at particle {}", side.to);
    const auto turns_left = [&](const Side& after) {
      const Eigen::Vector2i in = lattice.particles[side.to] - lattice.particles[side.from];
      const Eigen::Vector2i out = lattice.particles[after.to] - lattice.particles[after.from];
      return in.x() * out.y() - in.y() * out.x() > 0;
    };
    const bool two = first + 1 != sides.end() && (first + 1)->from == side.to;
    return static_cast<std::size_t>((two && turns_left(*(first + 1)) ? first + 1 : first) - sides.begin());
  };
  std::vector<std::vector<std::uint32_t>> loops;
  for (std::size_t start = 0; start < sides.size(); ++start) {
    if (used[start]) continue;
    std::vector<std::uint32_t>& loop = loops.emplace_back();
    for (std::size_t at = start; !used[at]; at = next(sides[at])) {
      used[at] = true;
      loop.push_back(sides[at].from);
    }
  }
  SC_ASSERT(std::ranges::all_of(loops, [](const auto& loop) { return loop.size() >= 4; }),
            "one of {} outlines has fewer sides than a cell", loops.size());
  return loops;
}

}  // namespace softcell::ppu
