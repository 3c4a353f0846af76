#pragma once
// How a point of a body meets one triangle of an obstacle.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "ppu/contacts/arrival.h"
#include "ppu/contacts/contact_terms.h"
#include "ppu/obstacles/known_triangles.h"
#include "ppu/obstacles/obstacle.h"
#include "ppu/surfaces/triangle_distance.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

// Cells: a point this deep behind a triangle, and deeper than kPressedThrough, has been pressed through it only if the line to it from well
// inside of the body crosses the triangle.
inline constexpr float kPressedDeepest = 2;

/// How far a point is beside a triangle, squared: 0 if it is above or below it.
/// @param normal  of the triangle, of unit length
template <typename Real>
Real squared_beside(const std::array<Eigen::Vector3f, 3>& triangle, const Eigen::Vector3f& normal,
                    const Eigen::Vector3f& point) {
  using Vector = Eigen::Vector3<Real>;
  const Vector n = normal.cast<Real>(), at = point.cast<Real>();
  const Vector beside =
      at -
      nearest_point<Real>({triangle[0].cast<Real>(), triangle[1].cast<Real>(), triangle[2].cast<Real>()}, at);
  return (beside - n * n.dot(beside)).squaredNorm();
}

/// One of an obstacle's triangles.
class ObstacleTriangle {
 public:
  ObstacleTriangle(const Obstacle& obstacle, const KnownTriangles& known, std::uint32_t number)
      : triangle_(obstacle.triangles[number]),
        face_(known.face(number)),
        box_(known.boxes().at(number)),
        rounding_(obstacle.rounding) {}

  bool has_area() const { return face_.area > 0; }
  const Eigen::Vector3f& normal() const { return face_.normal; }
  /// Height above the triangle's plane, on the side from which it is wound counterclockwise: metres.
  float height(const Eigen::Vector3f& point) const { return face_.normal.dot(point - triangle_[0]); }

  /// Whether a point is above or below the triangle, or beside it by no more than `most` metres. @pre has_area()
  bool is_over(const Eigen::Vector3f& point, float most) const {
    SC_ASSERT(has_area(), "a triangle of area {}", face_.area);
    // Most triangles are farther beside the point than above or below it: no need for the nearest point.
    const float farthest = 1.01f * (most + std::abs(height(point)));
    if ((point.array() < box_.low.array() - farthest).any() ||
        (point.array() > box_.high.array() + farthest).any())
      return false;
    if (is_exact(most)) return squared_beside<float>(triangle_, face_.normal, point) <= most * most;
    return squared_beside<double>(triangle_, face_.normal, point) <= double{most} * double{most};
  }

  /// Whether a point that is not deep behind the triangle has nothing to do with it, as it is never above or below it. For most triangles
  /// near a point a look at their boxes shows it; false: it may have to do with it. @pre has_area()
  bool passes_beside(const PointWay& way, float spacing) const {
    SC_ASSERT(has_area(), "a triangle of area {}", face_.area);
    const float most = kNear * spacing;
    const float from = height(way.from), to = height(way.to);
    if (std::abs(from) > kPressedThrough * spacing || !is_exact(most)) return false;
    const Eigen::Vector3f a = way.from - from * face_.normal, b = way.to - to * face_.normal;
    const float farthest = 2 * most + 0.01f * std::max(std::abs(from), std::abs(to));
    return (a.cwiseMax(b).array() < box_.low.array() - farthest).any() ||
           (a.cwiseMin(b).array() > box_.high.array() + farthest).any();
  }

  /// Whether two points are on different sides of the triangle's plane.
  bool parts(const Eigen::Vector3f& a, const Eigen::Vector3f& b) const {
    return face_.cross.dot(a - triangle_[0]) * face_.cross.dot(b - triangle_[0]) < 0;
  }

  /// @param front  1 or -1: the front is the side from which it is wound counterclockwise, or the other one
  /// @param inside  a place of the point's body, before the substep
  /// @param allowance  metres: TouchPoint::allowance
  std::optional<ObstacleHit> meet(const PointWay& way, const Eigen::Vector3f& inside, float spacing,
                                  float front, float allowance) const {
    if (!has_area()) return {};
    const float near = kNear * spacing;
    if (allowance > 0) return meet_outside(way, inside, spacing, front, allowance);
    float side = front;
    float from = side * height(way.from);
    bool is_deep = false;
    if (from < -kPressedThrough * spacing) {
      const float of_inside = side * height(inside);
      const bool may_be_deep = from > -kPressedDeepest * spacing && of_inside > 0;
      const float crossing = of_inside / (of_inside - from);
      is_deep = may_be_deep && is_over(inside + crossing * (way.from - inside), near);
      if (!is_deep) side = -side, from = -from;
    }
    const float to = side * height(way.to) - rounding_;
    if (to > near) return {};
    if (is_deep) return ObstacleHit{side * normal(), to};  // the next triangle may be the one over the point
    const float share =
        from - to > 0 ? std::clamp((from - rounding_) / (from - rounding_ - to), 0.0f, 1.0f) : 0.0f;
    if (!is_over(way.from + share * (way.to - way.from), near)) return {};
    return ObstacleHit{side * normal(), to};
  }

 private:
  /// For triangles of a kilometre, or needles, floats give the nearest point only to a tenth of a millimetre, or worse.
  bool is_exact(float most) const { return face_.rounding < most * face_.area; }

  /// Tests a point outside of the drawn surface: it is as deep behind the triangle as `allowance` says, or deeper, and the line to it from
  /// the inside of its body crosses the triangle. Where a body is pressed flat, its inside may be a little behind the triangle, too.
  std::optional<ObstacleHit> meet_outside(const PointWay& way, const Eigen::Vector3f& inside, float spacing,
                                          float front, float allowance) const {
    const float near = kNear * spacing;
    const float to = front * height(way.to) - rounding_ + allowance, of_inside = front * height(inside);
    if (to > near || of_inside < -kPressedThrough * spacing) return {};
    const ObstacleHit hit{front * normal(), to};
    if (of_inside <= 0) return is_over(way.to, near) ? std::optional(hit) : std::nullopt;
    const float from = front * height(way.from);
    const Eigen::Vector3f& before = from < 0 ? inside : way.from;
    const Eigen::Vector3f& after = from < 0 ? way.from : way.to;
    const float above = front * height(before), below = front * height(after);
    if (!is_over(before + above / (above - below) * (after - before), near)) return {};
    return hit;
  }

  const std::array<Eigen::Vector3f, 3>& triangle_;
  const KnownTriangles::Face& face_;
  Bounds<3> box_;
  float rounding_;
};

}  // namespace softcell::ppu
