#include "mesh_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

using Eigen::Vector3f;

/// Vertices at one place: several where normals or texture coordinates differ.
struct Place {
  std::uint32_t first = 0, count = 0;  ///< in Places::vertices
  Vector3f position{0, 0, 0};
  Vector3f normal{0, 0, 0};  ///< the sum of theirs
};

struct Places {
  std::vector<std::uint32_t> vertices;  ///< sorted by place
  std::vector<Place> all;
  std::vector<std::uint32_t> of_vertex;
};

Places places_of(std::span<const Vector3f> positions, std::span<const Vector3f> normals) {
  Places places;
  places.vertices.resize(positions.size());
  places.of_vertex.resize(positions.size());
  std::iota(places.vertices.begin(), places.vertices.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    return std::array{positions[v].x(), positions[v].y(), positions[v].z()};
  };
  std::ranges::sort(places.vertices, [&](std::uint32_t a, std::uint32_t b) {
    return key(a) != key(b) ? key(a) < key(b) : a < b;
  });
  for (std::uint32_t i = 0; i < places.vertices.size(); ++i) {
    const std::uint32_t vertex = places.vertices[i];
    if (places.all.empty() || places.all.back().position != positions[vertex])
      places.all.push_back({.first = i, .count = 0, .position = positions[vertex], .normal = {0, 0, 0}});
    Place& place = places.all.back();
    ++place.count;
    place.normal += normals[vertex].normalized();
    places.of_vertex[vertex] = static_cast<std::uint32_t>(places.all.size() - 1);
  }
  return places;
}

/// The same for places that are joined: the cube, and the octant that they face.
std::uint64_t cluster_of(const Place& place, const Vector3f& low, float spacing) {
  constexpr float kLast = (1 << 20) - 1;
  std::uint64_t cluster = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float cube = std::min(std::floor((place.position[axis] - low[axis]) / spacing), kLast);
    cluster = cluster << 21 | std::uint64_t{static_cast<std::uint32_t>(cube)} << 1 |
              std::uint64_t{place.normal[axis] < 0};
  }
  return cluster;
}

/// For each place the one that it is moved to.
std::vector<std::uint32_t> representatives(const Places& places, const Vector3f& low, float spacing) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
  sorted.reserve(places.all.size());
  for (std::uint32_t i = 0; i < places.all.size(); ++i)
    sorted.emplace_back(cluster_of(places.all[i], low, spacing), i);
  std::ranges::sort(sorted);
  std::vector<std::uint32_t> to(places.all.size());
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    Vector3f middle{0, 0, 0};
    for (end = begin; end < sorted.size() && sorted[end].first == sorted[begin].first; ++end)
      middle += places.all[sorted[end].second].position;
    middle /= static_cast<float>(end - begin);
    // Creases keep their place; else it is the one in the middle.
    std::uint32_t best = sorted[begin].second;
    const auto rank = [&](std::uint32_t place) {
      return std::pair(-static_cast<std::int64_t>(places.all[place].count),
                       (places.all[place].position - middle).squaredNorm());
    };
    for (std::size_t i = begin; i < end; ++i)
      if (rank(sorted[i].second) < rank(best)) best = sorted[i].second;
    for (std::size_t i = begin; i < end; ++i) to[sorted[i].second] = best;
  }
  return to;
}

/// The vertex of a place whose normal is most like another.
std::uint32_t most_like(const Places& places, const Place& place, std::span<const Vector3f> normals,
                        const Vector3f& normal) {
  std::uint32_t best = places.vertices[place.first];
  float most = -std::numeric_limits<float>::infinity();
  for (std::uint32_t i = 0; i < place.count; ++i) {
    const std::uint32_t vertex = places.vertices[place.first + i];
    const float likeness = normals[vertex].dot(normal);
    if (likeness > most) {
      most = likeness;
      best = vertex;
    }
  }
  return best;
}

MeshLevel coarser(const Places& places, std::span<const Vector3f> normals,
                  std::span<const Triangle> triangles, const Vector3f& low, float spacing) {
  const std::vector<std::uint32_t> to = representatives(places, low, spacing);
  MeshLevel level;
  double squares = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Place &from = places.all[i], &kept = places.all[to[i]];
    const Vector3f moved = kept.position - from.position;
    level.spacing = std::max(level.spacing, moved.norm());
    const double away = moved.dot(from.normal.normalized());
    squares += away * away;
  }
  level.error = static_cast<float>(std::sqrt(squares / static_cast<double>(to.size())));
  for (const Triangle& triangle : triangles) {
    Triangle moved{};
    std::array<std::uint32_t, 3> place{};
    for (std::size_t k = 0; k < 3; ++k) {
      place[k] = to[places.of_vertex[triangle[k]]];
      moved[k] = most_like(places, places.all[place[k]], normals, normals[triangle[k]]);
    }
    if (place[0] != place[1] && place[1] != place[2] && place[2] != place[0])
      level.triangles.push_back(moved);
  }
  return level;
}

Vector3f lowest(std::span<const Vector3f> positions) {
  Vector3f low = positions.front();
  for (const Vector3f& position : positions) low = low.cwiseMin(position);
  return low;
}

/// The middle one of all triangles' longest edges, metres.
float usual_edge(std::span<const Vector3f> positions, std::span<const Triangle> triangles) {
  std::vector<float> edges;
  edges.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    const float squared = std::max({(positions[t[0]] - positions[t[1]]).squaredNorm(),
                                    (positions[t[1]] - positions[t[2]]).squaredNorm(),
                                    (positions[t[2]] - positions[t[0]]).squaredNorm()});
    edges.push_back(std::sqrt(squared));
  }
  const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
  std::ranges::nth_element(edges, middle);
  return *middle;
}

}  // namespace

MeshLevel coarser(std::span<const Vector3f> positions, std::span<const Vector3f> normals,
                  std::span<const Triangle> triangles, float spacing) {
  SC_ASSERT(positions.size() == normals.size() && !positions.empty(), "{} positions and {} normals",
            positions.size(), normals.size());
  SC_ASSERT(spacing > 0, "vertices {} m apart are joined", spacing);
  return coarser(places_of(positions, normals), normals, triangles, lowest(positions), spacing);
}

std::vector<MeshLevel> coarser_levels(std::span<const Vector3f> positions, std::span<const Vector3f> normals,
                                      std::span<const Triangle> triangles) {
  constexpr std::size_t kFew = 500;
  constexpr double kFewer = 0.7;
  constexpr float kGrowth = 1.4f;
  std::vector<MeshLevel> levels;
  std::size_t before = triangles.size();
  if (before <= kFew || !std::ranges::all_of(positions, [](const Vector3f& p) { return p.allFinite(); }))
    return levels;
  const Places places = places_of(positions, normals);
  const Vector3f low = lowest(positions);
  const float edge = usual_edge(positions, triangles);
  if (!(edge > 0)) return levels;
  for (float spacing = 0.7f * edge; before > kFew && spacing < 64 * edge; spacing *= kGrowth) {
    MeshLevel level = coarser(places, normals, triangles, low, spacing);
    if (static_cast<double>(level.triangles.size()) > kFewer * static_cast<double>(before)) continue;
    before = level.triangles.size();
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace softcell::render
