#include "ppu/fracture/cut_triangle.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

__extension__ using Wide = __int128;  // products of three coordinates

template <class Number>
int sign(Number x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

class Cutter3d {
 public:
  explicit Cutter3d(const std::array<UnitPoint, 3>& corners)
      : corners_(corners), normal_(normal_of(corners)) {}

  std::vector<CutPolygon> cut() {
    CutPolygon whole;
    for (std::uint8_t k = 0; k < 3; ++k) {
      whole.vertices.push_back({.planes = 0, .of = k});
      whole.sides.push_back(k);
      whole.planes.push_back(0);
    }
    std::vector<CutPolygon> parts{std::move(whole)}, finer;
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      finer.clear();
      for (CutPolygon& part : parts) cut_along(std::move(part), axis, finer);
      parts.swap(finer);
    }
    return parts;
  }

 private:
  void cut_along(CutPolygon polygon, std::uint8_t axis, std::vector<CutPolygon>& parts) const {
    const auto [low, high] = std::minmax({corners_[0][axis], corners_[1][axis], corners_[2][axis]});
    const int last = static_cast<int>(high / kUnitsPerCell);
    for (int plane = static_cast<int>(low / kUnitsPerCell) + 1; plane <= last && !polygon.vertices.empty();
         ++plane) {
      CutPolygon below, above;
      below.cell = above.cell = polygon.cell;
      divide(polygon, axis, plane, below, above);
      below.cell[axis] = plane - 1;
      if (!below.vertices.empty()) parts.push_back(std::move(below));
      polygon = std::move(above);
    }
    if (polygon.vertices.empty()) return;
    polygon.cell[axis] = last;
    parts.push_back(std::move(polygon));
  }

  void divide(const CutPolygon& polygon, std::uint8_t axis, int plane, CutPolygon& below,
              CutPolygon& above) const {
    const std::size_t count = polygon.vertices.size();
    std::vector<bool> is_above(count);
    for (std::size_t i = 0; i < count; ++i) is_above[i] = lies_above(polygon.vertices[i], axis, plane);
    const auto append = [](CutPolygon& to, const CutVertex& vertex, std::uint8_t side, int of_plane) {
      to.vertices.push_back(vertex);
      to.sides.push_back(side);
      to.planes.push_back(of_plane);
    };
    const auto on_cut = static_cast<std::uint8_t>(CutPolygon::kOnPlane + axis);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t next = (i + 1) % count;
      CutPolygon& own = is_above[i] ? above : below;
      append(own, polygon.vertices[i], polygon.sides[i], polygon.planes[i]);
      if (is_above[i] == is_above[next]) continue;
      // The side crosses from one part to the other: the part that it leaves continues along the plane.
      const CutVertex crossing = crossing_of(polygon.sides[i], polygon.planes[i], axis, plane);
      append(own, crossing, on_cut, plane);
      append(is_above[i] ? below : above, crossing, polygon.sides[i], polygon.planes[i]);
    }
  }

  static CutVertex crossing_of(std::uint8_t side, int of_plane, std::uint8_t axis, int plane) {
    if (side < CutPolygon::kOnPlane) return {.planes = 1, .of = side, .axis = {axis}, .plane = {plane}};
    const auto before = static_cast<std::uint8_t>(side - CutPolygon::kOnPlane);
    SC_ASSERT(before < axis, "a plane of axis {} is cut at one of axis {}", before, axis);
    return {.planes = 2, .of = 0, .axis = {before, axis}, .plane = {of_plane, plane}};
  }

  bool lies_above(const CutVertex& vertex, std::uint8_t axis, int plane) const {
    for (std::size_t i = 0; i < vertex.planes; ++i)
      if (vertex.axis[i] == axis) return vertex.plane[i] > plane;
    const std::int64_t at = plane * kUnitsPerCell;
    if (vertex.planes == 0) return corners_[vertex.of][axis] > at;
    return vertex.planes == 1 ? side_lies_above(vertex, axis, at) : line_lies_above(vertex, axis, at);
  }

  /// A side a b meets the plane K of axis e at the coordinate a_d + (K - a_e) / (b_e - a_e) (b_d - a_d) along d.
  bool side_lies_above(const CutVertex& vertex, std::uint8_t d, std::int64_t at) const {
    const UnitPoint &a = corners_[vertex.of], &b = corners_[(vertex.of + 1u) % 3];
    const std::uint8_t e = vertex.axis[0];
    const std::int64_t along_e = b[e] - a[e], along_d = b[d] - a[d];
    const std::int64_t difference =
        (a[d] - at) * along_e + (vertex.plane[0] * kUnitsPerCell - a[e]) * along_d;
    int which = sign(difference);
    if (which == 0) which = e < d && along_d != 0 ? sign(along_d) : -sign(along_e);
    return which * sign(along_e) > 0;
  }

  /// A point P of the line is above the triangle's plane if n (P - a) > 0, which is n_d times (P_d - the coordinate where the line meets
  /// the plane).
  bool line_lies_above(const CutVertex& vertex, std::uint8_t d, std::int64_t at) const {
    UnitPoint point;
    for (std::size_t i = 0; i < 2; ++i) point[vertex.axis[i]] = vertex.plane[i] * kUnitsPerCell;
    point[d] = at;
    Wide height = 0;
    for (std::size_t i = 0; i < 3; ++i) height += Wide{normal_[i]} * (point[i] - corners_[0][i]);
    int which = sign(height);
    for (std::size_t i = 0; i < 3 && which == 0; ++i) which = sign(normal_[i]);
    return which * sign(normal_[d]) < 0;
  }

  const std::array<UnitPoint, 3>& corners_;
  UnitPoint normal_;
};

}  // namespace

UnitPoint normal_of(const std::array<UnitPoint, 3>& corners) {
  const auto& [a, b, c] = corners;
  UnitPoint normal;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t u = (i + 1) % 3, v = (i + 2) % 3;
    normal[i] = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
  }
  return normal;
}

std::vector<CutPolygon> cut_triangle(const std::array<UnitPoint, 3>& corners) {
  for (const UnitPoint& corner : corners)
    for (const std::int64_t at : corner)
      SC_ASSERT(at > 0 && at < kMaxUnits && at % 2 == 1, "a corner of a triangle at {} units", at);
  return Cutter3d(corners).cut();
}

}  // namespace softcell::ppu
