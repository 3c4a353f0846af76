#pragma once
// Rigid shapes as plain data: the obstacles that soft bodies collide with.
//
// A coupling to an engine describes what is near its soft bodies with these, before each substep. A compound
// is several of them with one rigid body.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ppu/obstacles/contact_rigid.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

enum class ObstacleKind : std::uint32_t {
  kPlane,     ///< the half-space y < 0
  kBox,       ///< half edges `extent`; with a rounding, a box of size 0 is a sphere, a line a capsule
  kCylinder,  ///< radius extent.x, half height extent.y, along y
  kCone,      ///< radius of the base extent.x, half height extent.y, the tip at +y
  kHull,      ///< the inside of all `planes`
  kTriangles  ///< no inside: both sides keep bodies out, whichever way they are wound
};

/// An edge or a tip of a shape, sharper than the surface that it may meet: contacts look it up in that body's field.
struct ObstacleEdge {
  Eigen::Vector3f from, to;  ///< the same for a tip
  /// Metres, at both ends: everything this near to the edge is inside. For the axis of a thin shape.
  float radius_from = 0, radius_to = 0;
  /// Metres: a body with cells of this size or smaller feels the edge with its own points and does not look it up.
  float cells_above = 0;

  float radius_at(float share) const { return radius_from + share * (radius_to - radius_from); }
};

/// A rigid shape as contacts see it. Its maker owns the lists to which the spans refer.
struct Obstacle {
  ObstacleKind kind = ObstacleKind::kPlane;
  std::uint32_t rigid = 0;  ///< index of its ContactRigid
  float friction = 1;       ///< of this shape, times its body's
  float restitution = 0;
  Eigen::Vector3f position{0, 0, 0};
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();  ///< from its frame to the world's
  Eigen::Vector3f extent{0, 0, 0};                         ///< metres, by kind
  float rounding = 0;                            ///< metres: everything this near to the shape is inside
  std::span<const Eigen::Vector4f> planes = {};  ///< outward unit normal, and its distance from 0
  std::span<const std::array<Eigen::Vector3f, 3>> triangles = {};
  bool faces_bodies = false;  ///< of triangles: known to be wound so that their fronts are towards the bodies
  std::uint32_t part = 0;     ///< number within the rigid body: triangles of one part are wound alike
  /// For triangles: three for each, in their order; none: their sides.
  std::span<const ObstacleEdge> edges = {};

  Eigen::Vector3f to_own(const Eigen::Vector3f& world) const {
    return rotation.transpose() * (world - position);
  }
  Eigen::Vector3f to_world(const Eigen::Vector3f& own) const { return rotation * own + position; }

  std::size_t edge_count() const { return has_sides() ? 3 * triangles.size() : edges.size(); }
  /// @param i  below edge_count()
  ObstacleEdge edge(std::size_t i) const {
    if (!has_sides()) return edges[i];
    const std::array<Eigen::Vector3f, 3>& triangle = triangles[i / 3];
    return {triangle[i % 3], triangle[(i + 1) % 3]};
  }
  /// Whether the sides of triangles are the edges.
  bool has_sides() const { return kind == ObstacleKind::kTriangles && edges.empty(); }
};

/// How far a point is from a shape, and the direction away from it.
struct Separation {
  float distance = 0;               ///< metres, below 0 inside
  Eigen::Vector3f normal{0, 1, 0};  ///< unit length
};

/// Whether two boxes have a point in common.
template <int kDimension>
bool overlap(const Bounds<kDimension>& a, const Bounds<kDimension>& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

/// The box in the world around a box in the obstacle's frame. A point in the one is in the other, however places are rounded.
Bounds<3> to_world(const Obstacle& obstacle, const Bounds<3>& box);

/// A box around the obstacle, in the world; infinite for a plane.
Bounds<3> bounds(const Obstacle& obstacle);

/// @param point  in the obstacle's frame; so is the result. @pre  the obstacle's kind has an inside: it is not kTriangles
Separation separation(const Obstacle& obstacle, const Eigen::Vector3f& point);
/// Whether the surface near a point of it may turn by more than 0.1 radians within `reach` (metres): at an edge, or where it is round.
/// @param point  in the obstacle's frame   @pre  it has an inside
bool may_turn_near(const Obstacle& obstacle, const Eigen::Vector3f& point, float reach);

}  // namespace softcell::ppu
