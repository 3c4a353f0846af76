#include "ppu/obstacles/triangle_sheets.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace softcell::ppu {

/// The lowest triangle that is known to be joined to a triangle.
std::uint32_t TriangleSheets::root_of(std::uint32_t triangle) {
  while (parents_[triangle] != triangle) triangle = parents_[triangle] = parents_[parents_[triangle]];
  return triangle;
}

void TriangleSheets::find(std::span<const std::array<Eigen::Vector3f, 3>> triangles) {
  sides_.clear();
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const ExactPoint from = exact_point(triangles[t][i]), to = exact_point(triangles[t][(i + 1) % 3]);
      sides_.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  parents_.resize(triangles.size());
  std::iota(parents_.begin(), parents_.end(), 0u);
  for (auto first = sides_.begin(); first != sides_.end();) {
    const auto end =
        std::find_if_not(first, sides_.end(), [&](const Side& side) { return side.joins(*first); });
    if (end - first == 2 && first->runs_up != first[1].runs_up) {
      const std::uint32_t one = root_of(first->triangle), other = root_of(first[1].triangle);
      parents_[std::max(one, other)] = std::min(one, other);
    }
    first = end;
  }
  count_ = 0;
  sheets_.resize(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t root = root_of(t);
    sheets_[t] = root == t ? static_cast<std::uint32_t>(count_++) : sheets_[root];
  }
}

}  // namespace softcell::ppu
