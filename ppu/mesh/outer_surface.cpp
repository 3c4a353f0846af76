#include "ppu/mesh/outer_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Corners = std::array<Vector3f, 3>;

float longest_edge(const Corners& t) {
  return std::sqrt(
      std::max({(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()}));
}

/// Into four by the middles of its edges.
std::array<Corners, 4> quarters(const Corners& t) {
  const Vector3f ab = 0.5f * (t[0] + t[1]), bc = 0.5f * (t[1] + t[2]), ca = 0.5f * (t[2] + t[0]);
  return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

/// Sorts triangles into those that bound the solid and those within it.
class SurfaceSorter {
 public:
  SurfaceSorter(const Solid& solid, float cell) : solid_(solid), cell_(cell) {}

  /// Appends what of the triangle bounds the solid, as few triangles as possible. @return whether all of it does
  bool sort(const Corners& triangle) {
    const float longest = longest_edge(triangle);
    if (longest > cell_) return sort_quarters(triangle);
    const bool within = is_within(triangle, {1, 1, 1});
    if (longest > kSmallest * cell_ && !is_all(triangle, within)) return sort_quarters(triangle);
    if (!within) outside.push_back(triangle);
    return !within;
  }

  std::vector<Corners> outside;

 private:
  static constexpr float kSmallest = 0.125f, kBeside = 1e-3f;  // cells

  /// Whether both sides of a triangle lie inside, at a place with these weights of its corners.
  bool is_within(const Corners& t, const Vector3f& weights) const {
    const Vector3f normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const Vector3f at = (weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2]) / weights.sum();
    const Vector3f beside = kBeside * cell_ * normal;
    return solid_.contains(at + beside) && solid_.contains(at - beside);
  }
  /// Whether that is so near all corners, or near none.
  bool is_all(const Corners& t, bool within) const {
    return is_within(t, {10, 1, 1}) == within && is_within(t, {1, 10, 1}) == within &&
           is_within(t, {1, 1, 10}) == within;
  }
  bool sort_quarters(const Corners& triangle) {
    const std::size_t before = outside.size();
    bool all = true;
    for (const Corners& quarter : quarters(triangle))
      if (!sort(quarter)) all = false;
    if (!all) return false;
    outside.resize(before);
    outside.push_back(triangle);
    return true;
  }

  const Solid& solid_;
  float cell_;
};

float area_of(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2; }

}  // namespace

std::optional<TriangleMesh> outer_surface(const TriangleMesh& mesh, const Solid& solid, float cell) {
  SC_ASSERT(cell > 0, "the surface of {} triangles to a part of {} m", mesh.triangles.size(), cell);
  if (!solid.is_whole()) return std::nullopt;
  SurfaceSorter sorter(solid, cell);
  float area = 0, within = 0;
  for (const auto& t : mesh.triangles) {
    const Corners corners{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    const float its_area = area_of(corners);
    if (!(its_area > 0)) continue;
    area += its_area;
    const std::size_t before = sorter.outside.size();
    if (sorter.sort(corners)) continue;
    within += its_area;
    for (std::size_t i = before; i < sorter.outside.size(); ++i) within -= area_of(sorter.outside[i]);
  }
  constexpr float kNothing = 1e-3f;  // of the surface
  if (within <= kNothing * area) return std::nullopt;
  TriangleMesh surface;
  for (const auto& t : sorter.outside) {
    const auto first = static_cast<std::uint32_t>(surface.positions.size());
    const Vector3f normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    for (const Vector3f& corner : t) {
      surface.positions.push_back(corner);
      surface.normals.push_back(normal);
    }
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

}  // namespace softcell::ppu
