#include "ppu/obstacles/obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// Inside the box, the way out leads through the nearest face; outside, away from the nearest point.
Separation from_box(const Vector3f& half, const Vector3f& p) {
  const Vector3f beyond = p.cwiseAbs() - half;
  Eigen::Index axis;
  const float nearest = beyond.maxCoeff(&axis);
  if (nearest <= 0) {
    Separation inside{nearest, Vector3f::Zero()};
    inside.normal[axis] = p[axis] < 0 ? -1.0f : 1.0f;
    return inside;
  }
  const Vector3f away = p - p.cwiseMax(-half).cwiseMin(half);
  const float distance = away.norm();
  return {distance, away / distance};
}

/// Distance and normal of a convex outline in the half-plane of radius and height, which is turned about the y axis.
struct Profile {
  float distance;
  Vector2f normal;  // by radius and height
};

/// The distance from a polygon of three or four corners, counter-clockwise; its edges on the axis do not count.
template <std::size_t kCorners>
Profile from_outline(const std::array<Vector2f, kCorners>& corner, const Vector2f& p) {
  Profile inside{-std::numeric_limits<float>::max(), Vector2f::UnitY()};
  float nearest = std::numeric_limits<float>::max();
  Vector2f away = Vector2f::UnitY();
  for (std::size_t i = 0; i + 1 < kCorners; ++i) {
    const Vector2f a = corner[i], edge = corner[i + 1] - a;
    const float length = edge.norm();
    if (!(length > 0)) continue;
    const Vector2f normal = Vector2f(edge.y(), -edge.x()) / length;
    const float height = normal.dot(p - a);
    if (height > inside.distance) inside = {height, normal};
    const float along = std::clamp(edge.dot(p - a) / (length * length), 0.0f, 1.0f);
    const Vector2f to_point = p - (a + along * edge);
    if (to_point.squaredNorm() < nearest) nearest = to_point.squaredNorm(), away = to_point;
  }
  if (inside.distance <= 0 || !(nearest > 0)) return inside;
  const float distance = std::sqrt(nearest);
  return {distance, away / distance};
}

Separation turned(const Profile& profile, const Vector3f& p, float radius) {
  const Vector3f outwards = radius > 0 ? Vector3f(p.x() / radius, 0, p.z() / radius) : Vector3f(1, 0, 0);
  return {profile.distance, profile.normal.x() * outwards + Vector3f(0, profile.normal.y(), 0)};
}

Separation from_cylinder(float radius, float half, const Vector3f& p) {
  const float r = std::hypot(p.x(), p.z());
  const std::array<Vector2f, 4> outline{Vector2f(0, -half), {radius, -half}, {radius, half}, {0, half}};
  return turned(from_outline(outline, {r, p.y()}), p, r);
}

Separation from_cone(float radius, float half, const Vector3f& p) {
  const float r = std::hypot(p.x(), p.z());
  const std::array<Vector2f, 3> outline{Vector2f(0, -half), {radius, -half}, {0, half}};
  return turned(from_outline(outline, {r, p.y()}), p, r);
}

/// Outside, near an edge or a corner, the result is less than the distance. A point outside is never taken to be inside.
Separation from_planes(std::span<const Eigen::Vector4f> planes, const Vector3f& p) {
  Separation nearest{-std::numeric_limits<float>::max(), Vector3f::UnitY()};
  for (const Eigen::Vector4f& plane : planes) {
    const float height = plane.head<3>().dot(p) - plane.w();
    if (height > nearest.distance) nearest = {height, plane.head<3>()};
  }
  return nearest;
}

Separation from_core(const Obstacle& obstacle, const Vector3f& p) {
  switch (obstacle.kind) {
    case ObstacleKind::kPlane:
      return {p.y(), Vector3f::UnitY()};
    case ObstacleKind::kBox:
      return from_box(obstacle.extent, p);
    case ObstacleKind::kCylinder:
      return from_cylinder(obstacle.extent.x(), obstacle.extent.y(), p);
    case ObstacleKind::kCone:
      return from_cone(obstacle.extent.x(), obstacle.extent.y(), p);
    case ObstacleKind::kHull:
      return from_planes(obstacle.planes, p);
    case ObstacleKind::kTriangles:
      break;
  }
  SC_ASSERT(false, "triangles have no inside, kind {}", static_cast<std::uint32_t>(obstacle.kind));
  return {};
}

}  // namespace

/// Transforms the corners: rounding keeps the order of numbers, so points between the corners stay between them.
Bounds<3> to_world(const Obstacle& obstacle, const Bounds<3>& box) {
  Bounds<3> result{obstacle.to_world(box.low), obstacle.to_world(box.low)};
  for (unsigned k = 1; k < 8; ++k) {
    const Vector3f corner((k & 1u) != 0 ? box.high.x() : box.low.x(),
                          (k & 2u) != 0 ? box.high.y() : box.low.y(),
                          (k & 4u) != 0 ? box.high.z() : box.low.z());
    const Vector3f there = obstacle.to_world(corner);
    result.low = result.low.cwiseMin(there);
    result.high = result.high.cwiseMax(there);
  }
  return result;
}

Bounds<3> bounds(const Obstacle& obstacle) {
  if (obstacle.kind == ObstacleKind::kPlane) {
    const Vector3f endless = Vector3f::Constant(std::numeric_limits<float>::max());
    return {-endless, endless};
  }
  const Vector3f rounding = Vector3f::Constant(obstacle.rounding);
  if (obstacle.kind == ObstacleKind::kHull || obstacle.kind == ObstacleKind::kTriangles) {
    SC_ASSERT(obstacle.edge_count() > 0, "an obstacle of {} planes and {} triangles without edges",
              obstacle.planes.size(), obstacle.triangles.size());
    const Vector3f first = obstacle.to_world(obstacle.edge(0).from);
    Bounds<3> box{first, first};
    for (std::size_t i = 0; i < obstacle.edge_count(); ++i) {
      const ObstacleEdge edge = obstacle.edge(i);
      for (const Vector3f& end : {obstacle.to_world(edge.from), obstacle.to_world(edge.to)}) {
        box.low = box.low.cwiseMin(end);
        box.high = box.high.cwiseMax(end);
      }
    }
    return {box.low - rounding, box.high + rounding};
  }
  Vector3f half = obstacle.extent;
  if (obstacle.kind != ObstacleKind::kBox) half.z() = half.x();  // shapes that are turned about their axis
  const Vector3f reach = obstacle.rotation.cwiseAbs() * half + rounding;
  return {obstacle.position - reach, obstacle.position + reach};
}

bool may_turn_near(const Obstacle& obstacle, const Vector3f& point, float reach) {
  const float bend = 10 * reach;  // of a smaller radius than this
  if (obstacle.rounding >= bend) return false;
  switch (obstacle.kind) {
    case ObstacleKind::kPlane:
      return false;
    case ObstacleKind::kBox:
      return ((point.cwiseAbs() - obstacle.extent).array() > -reach).count() > 1;
    case ObstacleKind::kCylinder: {
      const float radius = obstacle.extent.x();
      const bool at_side = std::hypot(point.x(), point.z()) > radius - reach;
      const bool at_end = std::abs(point.y()) > obstacle.extent.y() - reach;
      return at_side && (at_end || radius < bend);
    }
    case ObstacleKind::kHull:
      return std::ranges::count_if(obstacle.planes, [&](const Eigen::Vector4f& plane) {
               return plane.head<3>().dot(point) - plane.w() > -reach;
             }) > 1;
    case ObstacleKind::kCone:
    case ObstacleKind::kTriangles:
      break;
  }
  return true;
}

Separation separation(const Obstacle& obstacle, const Vector3f& point) {
  Separation result = from_core(obstacle, point);
  result.distance -= obstacle.rounding;
  return result;
}

}  // namespace softcell::ppu
