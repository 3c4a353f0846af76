#include "ppu/mesh/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "ppu/numbers/disjoint_sets.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Number of each vertex's position; equal positions have equal numbers.
std::vector<std::uint32_t> corner_numbers(const TriangleMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> numbers;
  numbers.reserve(mesh.positions.size());
  for (const Vector3f& p : mesh.positions) {
    // + 0 makes -0 and 0 the same key.
    const std::array<float, 3> key{p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f};
    numbers.push_back(known.try_emplace(key, static_cast<std::uint32_t>(known.size())).first->second);
  }
  return numbers;
}

/// Twice the area, of a line along x: above 0 with the point left of the way from a to b, as seen against x. The same but for its
/// sign for the way back, however it is rounded: both triangles of an edge agree on which of them a line meets.
double area_beside(const Vector3d& a, const Vector3d& b, double y, double z) {
  const bool swapped = std::pair(b.y(), b.z()) < std::pair(a.y(), a.z());
  const Vector3d &from = swapped ? b : a, &to = swapped ? a : b;
  const double area = (to.y() - from.y()) * (z - from.z()) - (to.z() - from.z()) * (y - from.y());
  return swapped ? -area : area;
}

/// How often the edges of a triangle go round a point, across x: 1 or -1 inside, by the triangle's sense, else 0.
int turns(const std::array<Vector3d, 3>& triangle, double y, double z) {
  int sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d &a = triangle[k], &b = triangle[(k + 1) % 3];
    const bool a_is_above = a.z() > z, b_is_above = b.z() > z;
    if (a_is_above == b_is_above) continue;
    const double area = area_beside(a, b, y, z);
    if (b_is_above && area > 0) ++sum;
    if (a_is_above && area < 0) --sum;
  }
  return sum;
}

float longest_edge(const std::array<Vector3f, 3>& t) {
  return std::sqrt(
      std::max({(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()}));
}

/// Into four by the middles of its edges.
std::array<std::array<Vector3f, 3>, 4> quarters(const std::array<Vector3f, 3>& t) {
  const Vector3f ab = 0.5f * (t[0] + t[1]), bc = 0.5f * (t[1] + t[2]), ca = 0.5f * (t[2] + t[0]);
  return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

}  // namespace

Solid::Solid(const TriangleMesh& mesh) {
  SC_ASSERT(!mesh.positions.empty(), "{} triangles without corners", mesh.triangles.size());
  box_ = bounds(mesh);
  add_closed_parts(mesh);
  sort_into_columns();
}

/// Closed are parts in which each edge is passed as often in one direction as in the other.
void Solid::add_closed_parts(const TriangleMesh& mesh) {
  constexpr double kMostOpen = 0.05;  // share of the surface
  const std::vector<std::uint32_t> number = corner_numbers(mesh);
  DisjointSets parts(number.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, int>
      balance;  // of edges, from the lower corner to the higher
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = number[t[k]], b = number[t[(k + 1) % 3]];
      parts.unite(a, b);
      if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::vector<bool> is_open(number.size());
  for (const auto& [edge, count] : balance)
    if (count != 0) is_open[parts.find(edge.first)] = true;
  double area = 0, open = 0;
  for (const auto& t : mesh.triangles) {
    const std::array<Vector3d, 3> corners{mesh.positions[t[0]].cast<double>(),
                                          mesh.positions[t[1]].cast<double>(),
                                          mesh.positions[t[2]].cast<double>()};
    const double its_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    area += its_area;
    if (is_open[parts.find(number[t[0]])])
      open += its_area;
    else if (its_area > 0)
      triangles_.push_back(corners);
  }
  is_whole_ = open <= kMostOpen * area;
}

void Solid::sort_into_columns() {
  constexpr double kMostColumns = 512;  // along an axis
  const double wanted =
      std::clamp(std::ceil(std::sqrt(static_cast<double>(triangles_.size()))), 1.0, kMostColumns);
  const Eigen::Array2d low = box_.low.tail<2>().cast<double>(), high = box_.high.tail<2>().cast<double>();
  columns_.setConstant(static_cast<int>(wanted));
  column_low_ = low;
  columns_per_metre_ = (high - low > 0).select(wanted / (high - low).max(1e-300), 0.0);
  const auto column = [&](double y, double z) -> Eigen::Array2i {
    const Eigen::Array2d place = (Eigen::Array2d(y, z) - column_low_) * columns_per_metre_;
    return place.max(0.0).min(wanted - 1).cast<int>();
  };
  const auto for_each_column = [&](const std::array<Vector3d, 3>& t, const auto& work) {
    const Vector3d least = t[0].cwiseMin(t[1]).cwiseMin(t[2]), most = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    const Eigen::Array2i first = column(least.y(), least.z()), last = column(most.y(), most.z());
    for (int z = first.y(); z <= last.y(); ++z)
      for (int y = first.x(); y <= last.x(); ++y)
        work(static_cast<std::size_t>(z) * static_cast<std::size_t>(columns_.x()) +
             static_cast<std::size_t>(y));
  };
  begin_.assign(static_cast<std::size_t>(columns_.prod()) + 1, 0);
  for (const auto& t : triangles_) for_each_column(t, [&](std::size_t i) { ++begin_[i + 1]; });
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  items_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for_each_column(triangles_[t], [&](std::size_t i) { items_[next[i]++] = t; });
}

bool Solid::contains(const Vector3f& point) const {
  if ((point.array() < box_.low.array()).any() || (point.array() > box_.high.array()).any()) return false;
  const double x = point.x(), y = point.y(), z = point.z();
  const Eigen::Array2d place = (Eigen::Array2d(y, z) - column_low_) * columns_per_metre_;
  const Eigen::Array2i column = place.max(0.0).min((columns_ - 1).cast<double>()).cast<int>();
  const std::size_t i = static_cast<std::size_t>(column.y()) * static_cast<std::size_t>(columns_.x()) +
                        static_cast<std::size_t>(column.x());
  int winding = 0;
  for (std::uint32_t k = begin_[i]; k < begin_[i + 1]; ++k) {
    const auto& t = triangles_[items_[k]];
    const int sense = turns(t, y, z);
    if (sense == 0) continue;
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double at = t[0].x() - (normal.y() * (y - t[0].y()) + normal.z() * (z - t[0].z())) / normal.x();
    if (at > x) winding += sense;
  }
  return winding != 0;
}

namespace {

/// Sorts triangles into those that bound the solid and those within it.
class SurfaceSorter {
 public:
  SurfaceSorter(const Solid& solid, float cell) : solid_(solid), cell_(cell) {}

  /// Appends what of the triangle bounds the solid, as few triangles as possible. @return whether all of it does
  bool sort(const std::array<Vector3f, 3>& triangle) {
    const float longest = longest_edge(triangle);
    const std::size_t before = outside.size();
    if (longest > cell_ || (longest > kSmallest * cell_ && !is_uniform(triangle))) {
      bool all = true;
      for (const auto& quarter : quarters(triangle))
        if (!sort(quarter)) all = false;
      if (!all) return false;
      outside.resize(before);
    } else if (is_within(triangle, {1, 1, 1})) {
      return false;
    }
    outside.push_back(triangle);
    return true;
  }

  std::vector<std::array<Vector3f, 3>> outside;

 private:
  static constexpr float kSmallest = 0.125f, kBeside = 1e-3f;  // cells

  /// Whether both sides of a triangle lie inside, at a place with these weights of its corners.
  bool is_within(const std::array<Vector3f, 3>& t, const Vector3f& weights) const {
    const Vector3f normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const Vector3f at = (weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2]) / weights.sum();
    const Vector3f beside = kBeside * cell_ * normal;
    return solid_.contains(at + beside) && solid_.contains(at - beside);
  }
  bool is_uniform(const std::array<Vector3f, 3>& t) const {
    const bool middle = is_within(t, {1, 1, 1});
    return is_within(t, {10, 1, 1}) == middle && is_within(t, {1, 10, 1}) == middle &&
           is_within(t, {1, 1, 10}) == middle;
  }

  const Solid& solid_;
  float cell_;
};

float area_of(const std::array<Vector3f, 3>& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2; }

}  // namespace

TriangleMesh outer_surface(const TriangleMesh& mesh, const Solid& solid, float cell) {
  SC_ASSERT(cell > 0, "the surface of {} triangles to a part of {} m", mesh.triangles.size(), cell);
  if (!solid.is_whole()) return mesh;
  SurfaceSorter sorter(solid, cell);
  float area = 0, within = 0;
  for (const auto& t : mesh.triangles) {
    const std::array<Vector3f, 3> corners{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    const float its_area = area_of(corners);
    if (!(its_area > 0)) continue;
    area += its_area;
    const std::size_t before = sorter.outside.size();
    if (sorter.sort(corners)) continue;
    within += its_area;
    for (std::size_t i = before; i < sorter.outside.size(); ++i) within -= area_of(sorter.outside[i]);
  }
  constexpr float kNothing = 1e-3f;  // of the surface
  if (within <= kNothing * area) return mesh;
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
