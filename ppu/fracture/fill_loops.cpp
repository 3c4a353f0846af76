#include "ppu/fracture/fill_loops.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2d;
using Loop = std::vector<std::uint32_t>;

/// Twice the area of a triangle, above 0 if it is counter-clockwise.
double area(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double area(std::span<const Vector2d> points, const Loop& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2d &a = points[loop[i]], &b = points[loop[(i + 1) % loop.size()]];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

bool encloses(std::span<const Vector2d> points, const Loop& loop, const Vector2d& at) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2d &a = points[loop[i]], &b = points[loop[(i + 1) % loop.size()]];
    if ((a.y() > at.y()) == (b.y() > at.y())) continue;
    if (at.x() < a.x() + (at.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

bool crosses(std::span<const Vector2d> points, const Loop& loop, std::uint32_t from, std::uint32_t to) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
    if (a == from || b == from || a == to || b == to) continue;
    if ((area(points[from], points[to], points[a]) > 0) != (area(points[from], points[to], points[b]) > 0) &&
        (area(points[a], points[b], points[from]) > 0) != (area(points[a], points[b], points[to]) > 0))
      return true;
  }
  return false;
}

/// Joins a hole to the loop around it by a bridge, used in both directions, between the two nearest points that see each other.
void join(std::span<const Vector2d> points, Loop& around, const Loop& hole, std::span<const Loop> holes) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> bridges;
  for (std::size_t i = 0; i < around.size(); ++i)
    for (std::size_t j = 0; j < hole.size(); ++j)
      bridges.emplace_back((points[around[i]] - points[hole[j]]).squaredNorm(), i, j);
  std::sort(bridges.begin(), bridges.end());
  const auto is_free = [&](const auto& bridge) {
    const std::uint32_t from = around[std::get<1>(bridge)], to = hole[std::get<2>(bridge)];
    return !crosses(points, around, from, to) &&
           std::none_of(holes.begin(), holes.end(),
                        [&](const Loop& other) { return crosses(points, other, from, to); });
  };
  const auto found = std::find_if(bridges.begin(), bridges.end(), is_free);
  const auto [length, from, to] = found != bridges.end() ? *found : bridges.front();
  Loop joined(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(from) + 1);
  for (std::size_t j = 0; j <= hole.size(); ++j) joined.push_back(hole[(to + j) % hole.size()]);
  joined.insert(joined.end(), around.begin() + static_cast<std::ptrdiff_t>(from), around.end());
  around = std::move(joined);
}

/// Cuts off one ear after the other.
void fill(std::span<const Vector2d> points, Loop loop, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  while (loop.size() > 3) {
    const std::size_t count = loop.size();
    const auto at = [&](std::size_t i) -> const Vector2d& { return points[loop[i % count]]; };
    std::size_t best = count;
    double roundest = -std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < count; ++i) {
      const Vector2d &a = at(i + count - 1), &b = at(i), &c = at(i + 1);
      const double size = area(a, b, c);
      const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      double round = longest > 0 ? size / longest : 0;
      if (size > 0) {
        const bool empty = std::none_of(loop.begin(), loop.end(), [&](std::uint32_t p) {
          const Vector2d& q = points[p];
          if (q == a || q == b || q == c) return false;
          return area(a, b, q) >= 0 && area(b, c, q) >= 0 && area(c, a, q) >= 0;
        });
        if (!empty) round -= 2;  // worse than any ear, if there are ears
      } else {
        round -= 4;
      }
      if (round > roundest) roundest = round, best = i;
    }
    SC_ASSERT(best < count, "a loop of {} points has no ear", count);
    triangles.push_back({loop[(best + count - 1) % count], loop[best], loop[(best + 1) % count]});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(best));
  }
  triangles.push_back({loop[0], loop[1], loop[2]});
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> fill_loops(std::span<const Vector2d> points,
                                                     std::vector<Loop> loops) {
  std::vector<Loop> outer, holes;
  for (Loop& loop : loops) {
    SC_ASSERT(loop.size() >= 3, "a loop of {} points", loop.size());
    (area(points, loop) < 0 ? holes : outer).push_back(std::move(loop));
  }
  // Of several loops around a hole, takes the smallest.
  std::vector<Loop> alone;
  for (const Loop& hole : holes) {
    Loop* around = nullptr;
    double smallest = std::numeric_limits<double>::max();
    for (Loop& loop : outer) {
      const double size = area(points, loop);
      if (size < smallest && encloses(points, loop, points[hole[0]])) smallest = size, around = &loop;
    }
    if (around != nullptr)
      join(points, *around, hole, holes);
    else
      alone.push_back(hole);
  }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const Loop& loop : outer) fill(points, loop, triangles);
  for (const Loop& loop : alone) fill(points, loop, triangles);
  return triangles;
}

}  // namespace softcell::ppu
