#include "rigid_shape_2d.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;

constexpr int kCirclePoints = 64;
constexpr int kCornerPoints = 6;
constexpr float kEdgeSlope = 0.5f;  // like a soft body's edge, but a little flatter

struct CornersOf {
  std::vector<Vector2f> operator()(const Box2dShape& box) const {
    const float x = box.size.x() / 2, y = box.size.y() / 2;
    return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  }
  std::vector<Vector2f> operator()(const PolygonShape& polygon) const { return polygon.corners; }
  std::vector<Vector2f> operator()(const CircleShape&) const { return {}; }
};

Vector2f direction(double angle) {
  return {static_cast<float>(ppu::cosine(angle)), static_cast<float>(ppu::sine(angle))};
}

/// Makes the outline with its normals; corners become arcs inside the polygon.
void round_corners(const std::vector<Vector2f>& corners, float rounding, std::vector<Vector2f>& outline,
                   std::vector<Vector2f>& normals) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2f before = corners[(i + n - 1) % n] - corners[i], behind = corners[(i + 1) % n] - corners[i];
    const Vector2f a = before.normalized(), b = behind.normalized();
    // Half the angle between the sides determines where on the sides an arc of this radius begins.
    const float cosine = a.dot(b), tangent = std::sqrt((1 - cosine) / std::max(1 + cosine, 1e-6f));
    const float along = std::min(rounding / tangent, 0.4f * std::min(before.norm(), behind.norm()));
    const float radius = along * tangent;
    const Vector2f middle = corners[i] + (a + b).normalized() * std::sqrt(along * along + radius * radius);
    const Vector2f first(-a.y(), a.x()), last(b.y(), -b.x());  // normals of the two sides
    for (int k = 0; k <= kCornerPoints; ++k) {
      const float t = static_cast<float>(k) / kCornerPoints;
      const Vector2f normal = ((1 - t) * first + t * last).normalized();
      outline.push_back(middle + radius * normal);
      normals.push_back(normal);
    }
  }
}

}  // namespace

RigidShape2d rigid_shape_2d(const RigidBody2d& body, float rounding, float bevel) {
  SC_ASSERT(rounding >= 0 && bevel >= 0, "corners of {} m, a bevel of {} m", rounding, bevel);
  RigidShape2d shape;
  std::vector<Vector2f> normals;
  float inradius = 0;
  if (const auto* circle = std::get_if<CircleShape>(&body.shape)) {
    for (int i = 0; i < kCirclePoints; ++i) {
      normals.push_back(direction(6.283185307179586 * i / kCirclePoints));
      shape.outline.push_back(circle->radius * normals.back());
    }
    inradius = circle->radius;
  } else {
    const std::vector<Vector2f> corners = std::visit(CornersOf{}, body.shape);
    inradius = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2f side = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
      inradius = std::min(inradius, std::abs(side.x() * corners[i].y() - side.y() * corners[i].x()));
    }
    round_corners(corners, std::min(rounding, 0.4f * inradius), shape.outline, normals);
  }
  // Two rings: the outline, and the line where the surface becomes level. Each inner point is an outline point moved towards the middle.
  const float width = std::min(bevel, 0.8f * inradius);
  const auto n = static_cast<std::uint32_t>(shape.outline.size());
  for (std::uint32_t i = 0; i < n; ++i)
    shape.vertices.push_back({.position = shape.outline[i],
                              .slope = bevel > 0 ? Vector2f(kEdgeSlope * normals[i]) : Vector2f(0, 0)});
  for (std::uint32_t i = 0; i < n; ++i)
    shape.vertices.push_back({.position = (1 - width / inradius) * shape.outline[i]});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    shape.triangles.push_back({i, next, n + next});
    shape.triangles.push_back({i, n + next, n + i});
    if (i >= 2) shape.triangles.push_back({n, n + i - 1, n + i});
  }
  return shape;
}

}  // namespace softcell::demos
