#include "softcell/soft_bodies/surface_query.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "ppu/numbers/box_around.h"
#include "ppu/numbers/cross.h"
#include "ppu/numbers/line_along_x.h"
#include "ppu/numbers/share_of_segment.h"
#include "ppu/surfaces/contact_surface.h"
#include "ppu/surfaces/flat_layer.h"
#include "ppu/surfaces/triangle_distance.h"
#include "ppu/surfaces/way_in_box.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/soft_bodies/skinned_mesh.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// A face of a surface: an edge of an outline, or a triangle.
template <int kDimension>
using FaceOf = std::array<Eigen::Vector<float, kDimension>, kDimension>;

constexpr std::uint32_t kFacesInLeaf = 4;
constexpr float kEndless = std::numeric_limits<float>::max();
constexpr float kBorder = 1e-5f;  // a ray at a border meets at least one of its two faces

template <int kDimension>
float square_of_distance(const Bounds<kDimension>& box, const Eigen::Vector<float, kDimension>& point) {
  return (point - point.cwiseMax(box.low).cwiseMin(box.high)).squaredNorm();
}

/// The fraction of a segment at which it enters a box; beyond 1: it does not.
template <int kDimension>
float entry_of(const Bounds<kDimension>& box, const Eigen::Vector<float, kDimension>& from,
               const Eigen::Vector<float, kDimension>& along) {
  const WayInBox part = way_in_box(box, from, along);
  return is_any(part) ? part.first : kEndless;
}

/// Points out of the body, if outlines go around it counter-clockwise. Its length is in proportion to the face.
Vector2f normal_of(const FaceOf<2>& edge) {
  const Vector2f along = edge[1] - edge[0];
  return {along.y(), -along.x()};
}
Vector3f normal_of(const FaceOf<3>& triangle) {
  return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

/// Whether a face is so narrow that rounding decides which way it looks. Cuts through bodies leave some. The faces beside it cover its
/// places.
bool is_sliver(const FaceOf<2>& edge) { return edge[0] == edge[1]; }
bool is_sliver(const FaceOf<3>& triangle) {
  constexpr float kNarrow = 1e-4f;  // height, as a share of the longest side
  float longest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    longest = std::max(longest, (triangle[(i + 1) % 3] - triangle[i]).squaredNorm());
  return normal_of(triangle).norm() <= kNarrow * longest;
}

/// Whether the line through a point along an axis meets a box.
template <int kDimension>
bool is_beside(const Bounds<kDimension>& box, int axis, const Eigen::Vector<float, kDimension>& point) {
  for (int d = 0; d < kDimension; ++d)
    if (d != axis && (point[d] < box.low[d] || point[d] > box.high[d])) return false;
  return true;
}

/// How the line through a point along an axis crosses a face: 1 or -1, by the sense of the face; 0: not at all. Faces with a common edge
/// agree on which of them the line crosses. @param ahead  if it crosses: whether beyond the point
int turns_of(const FaceOf<2>& edge, int axis, const Vector2f& point, bool& ahead) {
  const int up = 1 - axis;
  const bool a_is_above = edge[0][up] > point[up], b_is_above = edge[1][up] > point[up];
  if (a_is_above == b_is_above) return 0;
  const Eigen::Vector2d low = edge[a_is_above ? 1 : 0].cast<double>(), p = point.cast<double>(),
                        along = edge[a_is_above ? 0 : 1].cast<double>() - low;
  ahead = along[axis] * (p[up] - low[up]) > (p[axis] - low[axis]) * along[up];
  return b_is_above ? 1 : -1;
}
int turns_of(const FaceOf<3>& triangle, int axis, const Vector3f& point, bool& ahead) {
  const auto turned = [&](const Vector3f& v) {
    return Vector3f(v[axis], v[(axis + 1) % 3], v[(axis + 2) % 3]).cast<double>().eval();
  };
  const std::array<Eigen::Vector3d, 3> corners{turned(triangle[0]), turned(triangle[1]), turned(triangle[2])};
  const Eigen::Vector3d p = turned(point);
  const int turns = turns_around(corners, p.y(), p.z());
  if (turns != 0) ahead = place_in(corners, p.y(), p.z()) > p.x();
  return turns;
}

/// In proportion to the volume between the origin and a face; negative if the face's back is seen from outside.
float volume_below(const FaceOf<2>& edge) { return cross(edge[0], edge[1]); }
float volume_below(const FaceOf<3>& triangle) { return triangle[0].dot(triangle[1].cross(triangle[2])); }

/// The fraction of a segment at which it crosses a face; beyond 1: it does not.
float share_of(const FaceOf<2>& edge, const Vector2f& from, const Vector2f& along) {
  const Vector2f ab = edge[1] - edge[0], off = edge[0] - from;
  const float area = cross(along, ab);
  if (area == 0) return kEndless;
  const float at = cross(off, along) / area;
  if (at < -kBorder || at > 1 + kBorder) return kEndless;
  const float share = cross(off, ab) / area;
  return share >= 0 && share <= 1 ? share : kEndless;
}
/// [MT97]
float share_of(const FaceOf<3>& triangle, const Vector3f& from, const Vector3f& along) {
  const Vector3f ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const Vector3f across = along.cross(ac), off = from - triangle[0];
  const float volume = ab.dot(across);
  if (volume == 0) return kEndless;
  const float u = off.dot(across) / volume;
  const Vector3f turned = off.cross(ab);
  const float v = along.dot(turned) / volume;
  if (u < -kBorder || v < -kBorder || u + v > 1 + kBorder) return kEndless;
  const float share = ac.dot(turned) / volume;
  return share >= 0 && share <= 1 ? share : kEndless;
}

/// The point of an edge that is nearest to `point`.
Vector2f nearest_point(const FaceOf<2>& edge, const Vector2f& point) {
  const Vector2f along = edge[1] - edge[0];
  return edge[0] + share_of_segment(edge[0], along, point) * along;
}

std::vector<FaceOf<3>> faces_of(const SoftBody<3>& body) {
  const TriangleMesh& mesh = body.model().mesh();
  const TriangleMesh boundary = mesh.triangles.empty() ? boundary_of(body.model().lattice()) : TriangleMesh{};
  const TriangleMesh& surface = mesh.triangles.empty() ? boundary : mesh;
  std::vector<Vector3f> positions(surface.positions.size()), normals(surface.positions.size());
  if (mesh.triangles.empty())
    positions.assign(body.positions().begin(), body.positions().end());
  else
    skin(body, positions, normals);
  std::vector<FaceOf<3>> faces;
  for (const auto& t : surface.triangles)
    faces.push_back({positions[t[0]], positions[t[1]], positions[t[2]]});
  return faces;
}

std::vector<FaceOf<2>> faces_of(const SoftBody<2>& body, const Skin2d& drawn) {
  validate(drawn, body.model().lattice());
  std::vector<Vector2f> positions(drawn.rest.size()), slopes(drawn.rest.size());
  deform(drawn, body.positions(), positions, slopes);
  std::vector<FaceOf<2>> faces;
  for (const auto& loop : drawn.outlines)
    for (std::size_t i = 0; i < loop.size(); ++i)
      faces.push_back({positions[loop[i]], positions[loop[(i + 1) % loop.size()]]});
  return faces;
}

std::vector<FaceOf<2>> faces_of(const SoftBody<2>& body) {
  return faces_of(body, touching_skin(body.model()));
}

}  // namespace

template <int kDimension>
SurfaceQuery<kDimension>::SurfaceQuery(const SoftBody<kDimension>& body) : SurfaceQuery(faces_of(body)) {}

template <int kDimension>
template <std::same_as<Skin2d> Skin>
requires(kDimension == 2) SurfaceQuery<kDimension>::SurfaceQuery(const SoftBody<kDimension>& body,
                                                                 const Skin& drawn)
    : SurfaceQuery(faces_of(body, drawn)) {}

template <int kDimension>
SurfaceQuery<kDimension>::SurfaceQuery(std::vector<Face> faces) {
  SC_ASSERT(!faces.empty(), "a surface of {} faces", faces.size());
  float volume = 0;
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    for (const Vector& corner : faces[i])
      if (!corner.allFinite())
        throw std::runtime_error("a soft body's surface has positions that are not finite numbers");
    numbers_.push_back(i);
    is_narrow_.push_back(is_sliver(faces[i]));
    if (!is_narrow_[i]) volume += volume_below(faces[i]);
  }
  faces_ = std::move(faces);
  if (std::ranges::find(is_narrow_, false) == is_narrow_.end())  // the body is a line or a point
    is_narrow_.assign(faces_.size(), false);
  if (volume < 0) outwards_ = -1;
  nodes_.resize(1);
  build(0, 0, static_cast<std::uint32_t>(faces_.size()));
}

/// Splits the faces in halves along the longest axis of their middles.
template <int kDimension>
void SurfaceQuery<kDimension>::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  SC_ASSERT(count > 0 && first + count <= faces_.size(), "{} faces from {} on, of {}", count, first,
            faces_.size());
  Bounds<kDimension> box = box_around<Bounds<kDimension>>(faces_[first]),
                     middles{Vector::Constant(kEndless), Vector::Constant(-kEndless)};
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Bounds<kDimension> own = box_around<Bounds<kDimension>>(faces_[i]);
    box = {box.low.cwiseMin(own.low), box.high.cwiseMax(own.high)};
    const Vector middle = 0.5f * (own.low + own.high);
    middles = {middles.low.cwiseMin(middle), middles.high.cwiseMax(middle)};
  }
  nodes_[node] = {box, first, count};
  if (count <= kFacesInLeaf) return;
  Eigen::Index axis;
  (middles.high - middles.low).maxCoeff(&axis);
  // Sorts faces and numbers together, equal middles by number, so that the tree is the same everywhere.
  std::vector<std::uint32_t> order(count);
  for (std::uint32_t i = 0; i < count; ++i) order[i] = first + i;
  const auto place = [&](std::uint32_t i) {
    const Bounds<kDimension> own = box_around<Bounds<kDimension>>(faces_[i]);
    return own.low[axis] + own.high[axis];
  };
  const std::uint32_t half = count / 2;
  std::nth_element(order.begin(), order.begin() + half, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float at_a = place(a), at_b = place(b);
    return at_a != at_b ? at_a < at_b : numbers_[a] < numbers_[b];
  });
  std::vector<Face> faces;
  std::vector<std::uint32_t> numbers;
  std::vector<bool> is_narrow;
  for (const std::uint32_t i : order) {
    faces.push_back(faces_[i]);
    numbers.push_back(numbers_[i]);
    is_narrow.push_back(is_narrow_[i]);
  }
  std::copy(faces.begin(), faces.end(), faces_.begin() + first);
  std::copy(numbers.begin(), numbers.end(), numbers_.begin() + first);
  std::copy(is_narrow.begin(), is_narrow.end(), is_narrow_.begin() + first);
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node] = {box, children, 0};
  build(children, first, half);
  build(children + 1, first + half, count - half);
}

template <int kDimension>
SurfaceHit<kDimension> SurfaceQuery<kDimension>::hit_of(std::uint32_t face, float share,
                                                        const Vector& position) const {
  const Vector normal = outwards_ * normal_of(faces_[face]);
  const float size = normal.norm();
  return {share, position, size > 0 ? Vector(normal / size) : Vector::UnitY().eval(), numbers_[face]};
}

template <int kDimension>
template <typename Cost, typename Limit, typename Work>
void SurfaceQuery<kDimension>::visit(const Cost& cost, const Limit& limit, const Work& work) const {
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

template <int kDimension>
std::optional<SurfaceHit<kDimension>> SurfaceQuery<kDimension>::cast_ray(const Vector& from,
                                                                         const Vector& to) const {
  SC_ASSERT(from.allFinite() && to.allFinite(), "a ray from ({}, {})", from.x(), from.y());
  const Vector along = to - from;
  float best = kEndless;
  std::uint32_t best_face = 0;
  visit([&](const Bounds<kDimension>& box) { return entry_of(box, from, along); },
        [&] { return std::min(best, 1.0f); },
        [&](std::uint32_t i) {
          if (is_narrow_[i]) return;
          const float share = share_of(faces_[i], from, along);
          // Of equally near faces, takes the one with the lower number.
          if (share < best || (share == best && share <= 1 && numbers_[i] < numbers_[best_face]))
            best = share, best_face = i;
        });
  if (best > 1) return std::nullopt;
  return hit_of(best_face, best, from + best * along);
}

/// Where several faces are equally near, at edges and corners, the one that looks at the point most
/// squarely decides about the side.
template <int kDimension>
typename SurfaceQuery<kDimension>::Nearest SurfaceQuery<kDimension>::nearest(const Vector& point) const {
  constexpr float kEqual = 1 + 1e-5f;
  Nearest best{.square = kEndless};
  visit([&](const Bounds<kDimension>& box) { return square_of_distance(box, point); },
        [&] { return best.square * kEqual; },
        [&](std::uint32_t i) {
          if (is_narrow_[i]) return;
          const Vector position = nearest_point(faces_[i], point), off = point - position;
          const float square = off.squaredNorm();
          if (square > best.square * kEqual) return;
          const float towards = off.dot(hit_of(i, 0, position).normal);
          const float facing = square > 0 ? std::abs(towards) / std::sqrt(square) : 1;
          if (square * kEqual < best.square || facing > best.facing)
            best = {std::min(square, best.square), facing, towards < 0, i, position};
        });
  return best;
}

template <int kDimension>
typename SurfaceQuery<kDimension>::Turns SurfaceQuery<kDimension>::turns_along(int axis,
                                                                               const Vector& point) const {
  Turns turns;
  visit([&](const Bounds<kDimension>& box) { return is_beside(box, axis, point) ? 0.0f : kEndless; },
        [] { return 0.0f; },
        [&](std::uint32_t i) {
          bool ahead = false;
          const int turn = turns_of(faces_[i], axis, point, ahead);
          turns.all += turn;
          if (ahead) turns.ahead += turn;
        });
  return turns;
}

/// The nonzero winding rule, as in Solid: where a surface reaches into itself, the nearest face may look at a point that is inside. A line
/// whose crossings do not sum up to 0 meets a part that is not closed and does not count. Most of the other lines along axes decide; if
/// there are as many for as against, the nearest face does.
template <int kDimension>
bool SurfaceQuery<kDimension>::is_inside(const Vector& point, const Nearest& nearest) const {
  if ((point.array() < bounds().low.array()).any() || (point.array() > bounds().high.array()).any())
    return false;
  int inside = 0, outside = 0;
  for (int axis = 0; axis < kDimension && inside < 2 && outside < 2; ++axis) {
    const Turns turns = turns_along(axis, point);
    if (turns.all == 0) ++(turns.ahead != 0 ? inside : outside);
  }
  return inside != outside ? inside > outside : nearest.behind;
}

template <int kDimension>
float SurfaceQuery<kDimension>::distance(const Vector& point) const {
  SC_ASSERT(point.allFinite(), "the distance of ({}, {})", point.x(), point.y());
  const Nearest found = nearest(point);
  return is_inside(point, found) ? -std::sqrt(found.square) : std::sqrt(found.square);
}

/// Moves the sphere on by its distance from the surface again and again, which is never too far.
template <int kDimension>
std::optional<SurfaceHit<kDimension>> SurfaceQuery<kDimension>::cast_sphere(const Vector& from,
                                                                            const Vector& to,
                                                                            float radius) const {
  if (!(radius > 0) || !std::isfinite(radius))
    throw std::invalid_argument("cast_sphere() of a sphere of " + base::shortest(radius) +
                                " m; expected is a positive radius");
  SC_ASSERT(from.allFinite() && to.allFinite(), "a sphere of {} m moves from or to infinity", radius);
  const Vector along = to - from;
  const float length = along.norm(), near = 1e-4f * radius;
  const float least_step = 1e-3f * radius;  // for a sphere that moves along a surface
  if (const Nearest found = nearest(from); is_inside(from, found))
    return hit_of(found.face, 0, found.position);
  float done = 0;
  for (;;) {
    const Vector centre = length > 0 ? Vector(from + done / length * along) : from;
    const Nearest found = nearest(centre);
    const float distance = std::sqrt(found.square);  // not below 0: the sphere comes from outside
    if (distance - radius <= near) {
      SurfaceHit hit = hit_of(found.face, length > 0 ? done / length : 0, found.position);
      if (distance > 0) hit.normal = (centre - found.position) / distance;
      return hit;
    }
    if (done >= length) return std::nullopt;
    done = std::min(length, done + std::max(distance - radius, least_step));
  }
}

template class SurfaceQuery<2>;
template SurfaceQuery<2>::SurfaceQuery(const SoftBody<2>&, const Skin2d&);
template class SurfaceQuery<3>;

}  // namespace softcell::ppu
