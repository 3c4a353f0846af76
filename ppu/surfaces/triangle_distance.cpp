#include "ppu/surfaces/triangle_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ppu/numbers/sorted_lists.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Vector3f;
using Eigen::Vector3i;

template Vector3f nearest_point(const std::array<Vector3f, 3>&, const Vector3f&);
template Eigen::Vector3d nearest_point(const std::array<Eigen::Vector3d, 3>&, const Eigen::Vector3d&);

TriangleGrid::TriangleGrid(const TriangleMesh& mesh, float cube_edge) : edge_(cube_edge) {
  SC_ASSERT(cube_edge > 0 && !mesh.triangles.empty(), "a grid of cubes of {} m over {} triangles", cube_edge,
            mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const std::array<Vector3f, 3> corners{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    if (!((corners[1] - corners[0]).cross(corners[2] - corners[0]).squaredNorm() > 0)) continue;
    triangles_.push_back(corners);
    const Vector3f middle = (corners[0] + corners[1] + corners[2]) / 3;
    float squared = 0;
    for (const Vector3f& corner : corners) squared = std::max(squared, (corner - middle).squaredNorm());
    constexpr float kRoundedUp = 1.0001f;
    spheres_.push_back({middle.x(), middle.y(), middle.z(), kRoundedUp * std::sqrt(squared)});
  }
  const Bounds<3> box = bounds(mesh);
  low_ = box.low;
  counts_ = ((box.high - box.low) / edge_).array().floor().cast<int>() + 1;

  const auto for_each_cube = [&](std::size_t number, const auto& work) {
    const auto& triangle = triangles_[number];
    const Vector3i first = cube_of(triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]));
    const Vector3i last = cube_of(triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]));
    for (int z = first.z(); z <= last.z(); ++z)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int x = first.x(); x <= last.x(); ++x)
          work(static_cast<std::size_t>((z * counts_.y() + y) * counts_.x() + x));
  };
  sort_into_lists(static_cast<std::size_t>(counts_.prod()), triangles_.size(), for_each_cube, begin_, items_);
}

Vector3i TriangleGrid::cube_of(const Vector3f& point) const {
  const Vector3f place = (point - low_) / edge_;
  const Vector3f last = (counts_.array() - 1).matrix().cast<float>();
  return place.cwiseMax(Vector3f::Zero()).cwiseMin(last).cast<int>();
}

struct TriangleGrid::Nearest {
  float squared = std::numeric_limits<float>::max();
  float facing = 0;  // of the point and the triangle: cosine, above 0 in front
  // A triangle farther away than this is not as near, however distances are rounded.
  float beyond = std::numeric_limits<float>::max();
};

void TriangleGrid::look_at_cube(const Vector3i& cube, const Vector3f& point, Nearest& nearest) const {
  if ((cube.array() < 0).any() || (cube.array() >= counts_.array()).any()) return;
  constexpr float kEquallyNear = 1.0001f;
  const auto index = static_cast<std::size_t>((cube.z() * counts_.y() + cube.y()) * counts_.x() + cube.x());
  for (std::uint32_t i = begin_[index]; i < begin_[index + 1]; ++i) {
    const Sphere& sphere = spheres_[items_[i]];
    const float dx = point.x() - sphere.x, dy = point.y() - sphere.y, dz = point.z() - sphere.z;
    const float far = nearest.beyond + sphere.radius;
    if (dx * dx + dy * dy + dz * dz > far * far) continue;
    const auto& triangle = triangles_[items_[i]];
    const Vector3f away = point - nearest_point(triangle, point);
    const float squared = away.squaredNorm();
    if (squared > nearest.squared * kEquallyNear) continue;
    const Vector3f normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    const float facing = squared > 0 ? away.dot(normal) / std::sqrt(squared) : 1;
    if (squared * kEquallyNear < nearest.squared || std::abs(facing) > std::abs(nearest.facing))
      nearest.facing = facing;
    if (squared < nearest.squared) {
      nearest.squared = squared;
      nearest.beyond = 1.001f * std::sqrt(squared) + 1e-5f * edge_;
    }
  }
}

float TriangleGrid::signed_distance(const Vector3f& point, float reach) const {
  const Vector3i centre = ((point - low_) / edge_).array().floor().cast<int>();
  Nearest nearest;
  const int last_ring = static_cast<int>(std::ceil(reach / edge_)) + 1;
  for (int ring = 0; ring <= last_ring; ++ring) {
    // A triangle in this ring is at least so far away.
    const float least = static_cast<float>(ring - 1) * edge_;
    if (ring > 0 && nearest.squared < least * least) break;
    for (int z = -ring; z <= ring; ++z)
      for (int y = -ring; y <= ring; ++y) {
        const bool whole_row = std::abs(z) == ring || std::abs(y) == ring;
        for (int x = -ring; x <= ring; x += whole_row || ring == 0 ? 1 : 2 * ring)
          look_at_cube(centre + Vector3i(x, y, z), point, nearest);
      }
  }
  const float distance = std::sqrt(nearest.squared);
  if (distance >= reach) return reach;
  return nearest.facing < 0 ? -distance : distance;
}

}  // namespace softcell::ppu
