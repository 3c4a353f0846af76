#include "ppu/mesh/vertex_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <vector>

#include "ppu/numbers/disjoint_sets.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// The squares of the components of shorter vectors lose bits to underflow, and with them the length.
constexpr double kLeastLength = 1e-140;

/// One side of a triangle. Corner 3 t + k is corner k of triangle t; the side runs from it to the next
/// corner.
struct HalfEdge {
  std::uint32_t low, high;  ///< the positions it joins, in order of number
  std::uint32_t corner;
  bool ascending;  ///< runs from low to high
};

std::uint32_t next_corner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

std::vector<HalfEdge> sorted_half_edges(std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), 3 * t + k, from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  });
  return edges;
}

/// Joins the corners on both ends of every smooth edge.
DisjointSets smooth_groups(std::span<const std::array<std::uint32_t, 3>> triangles,
                           std::span<const Eigen::Vector3d> face_normals, double crease_cosine) {
  SC_ASSERT(face_normals.size() == triangles.size(), "{} normals of {} triangles", face_normals.size(),
            triangles.size());
  DisjointSets groups(3 * triangles.size());
  const std::vector<HalfEdge> edges = sorted_half_edges(triangles);
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].low == edges[first].low &&
           edges[last].high == edges[first].high)
      ++last;
    if (last - first != 2 || edges[first].ascending == edges[first + 1].ascending) continue;
    const std::uint32_t a = edges[first].corner, b = edges[first + 1].corner;
    if (face_normals[a / 3].dot(face_normals[b / 3]) < crease_cosine) continue;
    groups.unite(a, next_corner(b));
    groups.unite(next_corner(a), b);
  }
  return groups;
}

}  // namespace

Eigen::Vector3d area_vector(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3d origin = a.cast<double>();
  return (b.cast<double>() - origin).cross(c.cast<double>() - origin);
}

TriangleMesh with_smooth_normals(std::span<const Eigen::Vector3f> positions,
                                 std::span<const std::array<std::uint32_t, 3>> triangles,
                                 double crease_cosine) {
  std::vector<Eigen::Vector3d> areas(triangles.size()), face_normals(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    SC_ASSERT(std::max({a, b, c}) < positions.size(), "triangle {} names position {} of {}", t,
              std::max({a, b, c}), positions.size());
    areas[t] = area_vector(positions[a], positions[b], positions[c]);
    SC_ASSERT(areas[t].norm() > 0, "triangle {} has no area", t);
    face_normals[t] = areas[t] / areas[t].norm();
  }
  DisjointSets groups = smooth_groups(triangles, face_normals, crease_cosine);

  TriangleMesh mesh;
  mesh.triangles.resize(triangles.size());
  std::vector<std::uint32_t> vertex_of_group(3 * triangles.size(), kNoVertex);
  std::vector<Eigen::Vector3d> sums;
  std::vector<std::uint32_t> some_triangle;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t position = triangles[t][k];
      std::uint32_t& vertex = vertex_of_group[groups.find(3 * t + k)];
      if (vertex == kNoVertex) {
        vertex = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(positions[position]);
        sums.emplace_back(0, 0, 0);
        some_triangle.push_back(t);
      }
      mesh.triangles[t][k] = vertex;
      const Eigen::Vector3d here = positions[position].cast<double>();
      const Eigen::Vector3d to_next = positions[triangles[t][(k + 1) % 3]].cast<double>() - here;
      const Eigen::Vector3d to_last = positions[triangles[t][(k + 2) % 3]].cast<double>() - here;
      sums[vertex] += areas[t] / (to_next.squaredNorm() * to_last.squaredNorm());
    }
  }
  mesh.normals.reserve(sums.size());
  for (std::size_t vertex = 0; vertex < sums.size(); ++vertex) {
    const double length = sums[vertex].norm();
    // A closed fan can cancel to nothing (a spike of no width); any of its faces is then as good as another.
    const bool usable = length > kLeastLength && length <= std::numeric_limits<double>::max();
    mesh.normals.push_back(
        (usable ? Eigen::Vector3d(sums[vertex] / length) : face_normals[some_triangle[vertex]])
            .cast<float>());
  }
  return mesh;
}

}  // namespace softcell::ppu
