#include "softcell/soft_bodies/surface_query.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "ppu/surfaces/contact_surface.h"
#include "ppu/surfaces/triangle_distance.h"
#include "ppu/surfaces/way_in_box.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/skinned_mesh.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr std::uint32_t kTrianglesInLeaf = 4;
constexpr float kFarthest = std::numeric_limits<float>::max();

Bounds<3> around(const std::array<Vector3f, 3>& triangle) {
  return {triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]),
          triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2])};
}

float square_of_distance(const Bounds<3>& box, const Vector3f& point) {
  return (point - point.cwiseMax(box.low).cwiseMin(box.high)).squaredNorm();
}

/// Where a way enters a box, as a share of it; beyond 1: nowhere.
float entry_of(const Bounds<3>& box, const Vector3f& from, const Vector3f& along) {
  const WayInBox part = way_in_box(box, from, along);
  // Rounding must not part two boxes that share a side.
  return part.first <= part.last + 1e-6f ? part.first : kFarthest;
}

/// The share of the way at which it passes a triangle; beyond 1: it does not.  [MT97]
float share_of(const std::array<Vector3f, 3>& triangle, const Vector3f& from, const Vector3f& along) {
  const Vector3f ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const Vector3f across = along.cross(ac), off = from - triangle[0];
  const float volume = ab.dot(across);
  if (volume == 0) return kFarthest;
  const float u = off.dot(across) / volume;
  const Vector3f turned = off.cross(ab);
  const float v = along.dot(turned) / volume;
  constexpr float kRounding = 1e-5f;  // a ray at an edge meets one of its two triangles at least
  if (u < -kRounding || v < -kRounding || u + v > 1 + kRounding) return kFarthest;
  const float share = ac.dot(turned) / volume;
  return share >= 0 && share <= 1 ? share : kFarthest;
}

}  // namespace

SurfaceQuery::SurfaceQuery(const SoftBody<3>& body) {
  const TriangleMesh& mesh = body.model().mesh();
  const TriangleMesh boundary = mesh.triangles.empty() ? boundary_of(body.model().lattice()) : TriangleMesh{};
  const TriangleMesh& surface = mesh.triangles.empty() ? boundary : mesh;
  std::vector<Vector3f> positions(surface.positions.size()), normals(surface.positions.size());
  if (mesh.triangles.empty())
    positions.assign(body.positions().begin(), body.positions().end());
  else
    skin(body, positions, normals);
  float volume = 0;
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& t = surface.triangles[i];
    const Triangle triangle{positions[t[0]], positions[t[1]], positions[t[2]]};
    for (const Vector3f& corner : triangle)
      if (!corner.allFinite())
        throw std::runtime_error("a soft body's surface has positions that are not finite numbers");
    triangles_.push_back(triangle);
    numbers_.push_back(i);
    volume += triangle[0].dot(triangle[1].cross(triangle[2]));
  }
  if (volume < 0) outwards_ = -1;
  nodes_.resize(1);
  build(0, 0, static_cast<std::uint32_t>(triangles_.size()));
}

/// Halves the triangles along the longest axis of their middles.
void SurfaceQuery::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  SC_ASSERT(count > 0 && first + count <= triangles_.size(), "{} triangles from {} on, of {}", count, first,
            triangles_.size());
  Bounds<3> box = around(triangles_[first]),
            middles{Vector3f::Constant(kFarthest), Vector3f::Constant(-kFarthest)};
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Bounds<3> own = around(triangles_[i]);
    box = {box.low.cwiseMin(own.low), box.high.cwiseMax(own.high)};
    const Vector3f middle = 0.5f * (own.low + own.high);
    middles = {middles.low.cwiseMin(middle), middles.high.cwiseMax(middle)};
  }
  nodes_[node] = {box, first, count};
  if (count <= kTrianglesInLeaf) return;
  Eigen::Index axis;
  (middles.high - middles.low).maxCoeff(&axis);
  // Triangles and numbers are sorted together; equal middles by number, so that the tree is the same everywhere.
  std::vector<std::uint32_t> order(count);
  for (std::uint32_t i = 0; i < count; ++i) order[i] = first + i;
  const auto place = [&](std::uint32_t i) {
    const Bounds<3> own = around(triangles_[i]);
    return own.low[axis] + own.high[axis];
  };
  const std::uint32_t half = count / 2;
  std::nth_element(order.begin(), order.begin() + half, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float at_a = place(a), at_b = place(b);
    return at_a != at_b ? at_a < at_b : numbers_[a] < numbers_[b];
  });
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> numbers;
  for (const std::uint32_t i : order) triangles.push_back(triangles_[i]), numbers.push_back(numbers_[i]);
  std::copy(triangles.begin(), triangles.end(), triangles_.begin() + first);
  std::copy(numbers.begin(), numbers.end(), numbers_.begin() + first);
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node] = {box, children, 0};
  build(children, first, half);
  build(children + 1, first + half, count - half);
}

SurfaceHit SurfaceQuery::hit_of(std::uint32_t triangle, float share, const Vector3f& position) const {
  const auto& [a, b, c] = triangles_[triangle];
  const Vector3f cross = outwards_ * (b - a).cross(c - a);
  const float area = cross.norm();
  return {share, position, area > 0 ? Vector3f(cross / area) : Vector3f::UnitY(), numbers_[triangle]};
}

template <typename Cost, typename Limit, typename Work>
void SurfaceQuery::visit(const Cost& cost, const Limit& limit, const Work& work) const {
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (cost(node.box) > limit()) continue;
    if (node.count == 0) {
      const bool second_first = cost(nodes_[node.first + 1].box) < cost(nodes_[node.first].box);
      open.push_back(node.first + (second_first ? 0 : 1));
      open.push_back(node.first + (second_first ? 1 : 0));
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) work(i);
  }
}

std::optional<SurfaceHit> SurfaceQuery::cast_ray(const Vector3f& from, const Vector3f& to) const {
  SC_ASSERT(from.allFinite() && to.allFinite(), "a ray from ({}, {}, {})", from.x(), from.y(), from.z());
  const Vector3f along = to - from;
  float best = kFarthest;
  std::uint32_t best_triangle = 0;
  visit([&](const Bounds<3>& box) { return entry_of(box, from, along); },
        [&] { return std::min(best, 1.0f); },
        [&](std::uint32_t i) {
          const float share = share_of(triangles_[i], from, along);
          // Of equal ones that with the lower number.
          if (share < best || (share == best && share <= 1 && numbers_[i] < numbers_[best_triangle]))
            best = share, best_triangle = i;
        });
  if (best > 1) return std::nullopt;
  return hit_of(best_triangle, best, from + best * along);
}

/// Where several triangles are equally near, at edges and corners, the one that looks at the point most
/// squarely decides about the side.
SurfaceQuery::Nearest SurfaceQuery::nearest(const Vector3f& point) const {
  constexpr float kEqual = 1 + 1e-5f;
  Nearest best{.square = kFarthest};
  visit([&](const Bounds<3>& box) { return square_of_distance(box, point); },
        [&] { return best.square * kEqual; },
        [&](std::uint32_t i) {
          const Vector3f position = nearest_point(triangles_[i], point), off = point - position;
          const float square = off.squaredNorm();
          if (square > best.square * kEqual) return;
          const float towards = off.dot(hit_of(i, 0, position).normal);
          const float facing = square > 0 ? std::abs(towards) / std::sqrt(square) : 1;
          if (square * kEqual < best.square || facing > best.facing)
            best = {std::min(square, best.square), facing, towards < 0, i, position};
        });
  return best;
}

float SurfaceQuery::Nearest::distance() const { return behind ? -std::sqrt(square) : std::sqrt(square); }

float SurfaceQuery::distance(const Vector3f& point) const {
  SC_ASSERT(point.allFinite(), "the distance of ({}, {}, {})", point.x(), point.y(), point.z());
  return nearest(point).distance();
}

/// Goes on by as much as is free, which is never too far.
std::optional<SurfaceHit> SurfaceQuery::cast_sphere(const Vector3f& from, const Vector3f& to,
                                                    float radius) const {
  SC_ASSERT(from.allFinite() && to.allFinite() && radius > 0, "a sphere of {} m", radius);
  const Vector3f along = to - from;
  const float length = along.norm(), near = 1e-4f * radius;
  const float least_step = 1e-3f * radius;  // of a way that runs along a surface
  float done = 0;
  for (;;) {
    const Vector3f centre = length > 0 ? Vector3f(from + done / length * along) : from;
    const Nearest found = nearest(centre);
    const float distance = found.distance();
    if (distance - radius <= near) {
      SurfaceHit hit = hit_of(found.triangle, length > 0 ? done / length : 0, found.position);
      if (distance > 0) hit.normal = (centre - found.position) / distance;
      return hit;
    }
    if (done >= length) return std::nullopt;
    done = std::min(length, done + std::max(distance - radius, least_step));
  }
}

}  // namespace softcell::ppu
