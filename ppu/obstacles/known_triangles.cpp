#include "ppu/obstacles/known_triangles.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <cstring>

#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Vector3f;

namespace {

/// Both lists hold floats without gaps.
template <typename T>
bool are_same(const std::vector<T>& known, std::span<const T> now) {
  if (known.size() != now.size()) return false;
  return now.empty() || std::memcmp(known.data(), now.data(), now.size_bytes()) == 0;
}

}  // namespace

void KnownTriangles::see(const Obstacle& obstacle, float longest) {
  static_assert(sizeof(ObstacleEdge) == 9 * sizeof(float));
  static_assert(sizeof(triangles_[0]) == 9 * sizeof(float));
  SC_ASSERT(obstacle.kind == ObstacleKind::kTriangles && !obstacle.triangles.empty() &&
                obstacle.edge_count() == 3 * obstacle.triangles.size(),
            "{} triangles with {} edges", obstacle.triangles.size(), obstacle.edge_count());
  if (longest == longest_ && are_same(triangles_, obstacle.triangles) && are_same(edges_, obstacle.edges))
    return;
  longest_ = longest;
  triangles_.assign(obstacle.triangles.begin(), obstacle.triangles.end());
  edges_.assign(obstacle.edges.begin(), obstacle.edges.end());
  boxes_.place(triangles_);
  find_faces();
  find_corners();
  find_long_edges(obstacle);
}

void KnownTriangles::find_faces() {
  faces_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    constexpr float kRounding = 2e-6f;
    const auto& triangle = triangles_[t];
    const Vector3f one = triangle[1] - triangle[0], other = triangle[2] - triangle[0];
    const float longest = (one.cwiseAbs() + other.cwiseAbs()).sum();
    Face& face = faces_[t];
    face.cross = one.cross(other);
    face.area = face.cross.norm();
    face.normal = face.cross / face.area;
    face.rounding = kRounding * longest * longest * longest;
  }
}

void KnownTriangles::find_corners() {
  set_.begin(3 * triangles_.size());
  corners_.clear();
  if (has_sides()) {
    corners_of_.resize(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) corners_of_[t] = set_.add(triangles_[t]);
  }
  for (const ObstacleEdge& edge : edges_) set_.add(edge.from);
  for (const CornerSet::Corner& corner : set_.corners())
    if (!corner.is_flat()) corners_.push_back(corner.point);
}

/// Sides at a flat corner do not stand out.
bool KnownTriangles::may_stand_out(std::size_t t, std::size_t side) const {
  const std::array<std::uint32_t, 3>& corners = corners_of_[t];
  return !set_.corners()[corners[side]].is_flat() && !set_.corners()[corners[(side + 1) % 3]].is_flat();
}

void KnownTriangles::find_long_edges(const Obstacle& obstacle) {
  is_long_.assign(obstacle.edge_count(), false);
  sides_.begin(obstacle.edge_count());
  has_long_edges_ = false;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    bool has_one = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const ObstacleEdge edge = obstacle.edge(3 * t + i);
      if ((edge.to - edge.from).squaredNorm() <= longest_ * longest_) continue;
      if (has_sides() && !may_stand_out(t, i)) continue;
      is_long_[3 * t + i] = has_one = true;
    }
    // Most triangles of a large mesh have no long side.
    if (has_one && has_sides()) sides_.add(t, triangles_[t]);
  }
  for (std::size_t i = 0; i < is_long_.size(); ++i) {
    is_long_[i] = is_long_[i] && !sides_.is_flat(i);
    has_long_edges_ = has_long_edges_ || is_long_[i];
  }
}

}  // namespace softcell::ppu
