#include "ppu/surfaces/known_triangles.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// Both are lists of floats without gaps.
template <typename T>
bool are_same(const std::vector<T>& known, std::span<const T> now) {
  return known.size() == now.size() && std::memcmp(known.data(), now.data(), now.size_bytes()) == 0;
}

/// Edges of two dimensions are no sides: they lie in their plane.
bool are_sides(std::span<const ObstacleEdge> edges, const CornerSet::Triangle& triangle) {
  for (std::size_t i = 0; i < 3; ++i)
    if (edges[i].from != triangle[i]) return false;
  return true;
}

}  // namespace

void KnownTriangles::see(const Obstacle& obstacle, float longest) {
  static_assert(sizeof(ObstacleEdge) == 6 * sizeof(float));
  static_assert(sizeof(triangles_[0]) == 9 * sizeof(float));
  SC_ASSERT(obstacle.kind == ObstacleKind::kTriangles && !obstacle.triangles.empty() &&
                obstacle.edges.size() == 3 * obstacle.triangles.size(),
            "{} triangles with {} edges", obstacle.triangles.size(), obstacle.edges.size());
  if (longest == longest_ && are_same(triangles_, obstacle.triangles) && are_same(edges_, obstacle.edges))
    return;
  longest_ = longest;
  triangles_.assign(obstacle.triangles.begin(), obstacle.triangles.end());
  edges_.assign(obstacle.edges.begin(), obstacle.edges.end());
  boxes_.place(triangles_);
  find_corners();
  find_long_edges();
}

void KnownTriangles::find_corners() {
  set_.begin(edges_.size());
  corners_of_.assign(triangles_.size(), {kNone, kNone, kNone});
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const std::span<const ObstacleEdge> edges(&edges_[3 * t], 3);
    if (are_sides(edges, triangles_[t])) {
      corners_of_[t] = set_.add(triangles_[t]);
      continue;
    }
    for (const ObstacleEdge& edge : edges) set_.add(edge.from);
  }
  corners_.clear();
  for (const CornerSet::Corner& corner : set_.corners())
    if (!corner.is_flat()) corners_.push_back(corner.point);
}

/// Sides at a flat corner do not.
bool KnownTriangles::may_stand_out(std::size_t t, std::size_t side) const {
  const std::array<std::uint32_t, 3>& corners = corners_of_[t];
  if (corners[0] == kNone) return true;
  return !set_.corners()[corners[side]].is_flat() && !set_.corners()[corners[(side + 1) % 3]].is_flat();
}

void KnownTriangles::find_long_edges() {
  is_long_.assign(edges_.size(), false);
  sides_.begin(edges_.size());
  has_long_edges_ = false;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    bool has_one = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const ObstacleEdge& edge = edges_[3 * t + i];
      if ((edge.to - edge.from).squaredNorm() <= longest_ * longest_ || !may_stand_out(t, i)) continue;
      is_long_[3 * t + i] = has_one = true;
    }
    // Most triangles of a large mesh have none.
    if (has_one && corners_of_[t][0] != kNone) sides_.add(t, triangles_[t]);
  }
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    is_long_[i] = is_long_[i] && !sides_.is_flat(i);
    has_long_edges_ = has_long_edges_ || is_long_[i];
  }
}

}  // namespace softcell::ppu
