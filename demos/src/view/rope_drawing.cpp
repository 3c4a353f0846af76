#include "rope_drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;

constexpr int kRopeSegments = 16;       // of a slack rope
constexpr float kLeastSlack = 1.0005f;  // times the distance between its ends
constexpr float kKnot = 1.6f;           // times the rope's radius

}  // namespace

/// A flat arc of sag s over a chord d is d + 8 s^2 / (3 d) long.
float rope_sag(float distance, float length) {
  if (!(length > kLeastSlack * distance)) return 0;
  const float chord = std::max(distance, 0.2f * length);  // an arc that is not flat would hang too low
  return std::sqrt(0.375f * chord * (length - chord));
}

Eigen::AlignedBox3f around_rope(const ShownRope<3>& rope, const Vector3f& down) {
  Eigen::AlignedBox3f box;
  box.extend(rope.ends[0]).extend(rope.ends[1]);
  const Vector3f middle = 0.5f * (rope.ends[0] + rope.ends[1]);
  // The arc lies below its chord and above the tangents at its ends, which meet twice the sag below the middle.
  box.extend(Vector3f(middle + 2 * rope_sag((rope.ends[1] - rope.ends[0]).norm(), rope.length) * down));
  const Vector3f reach = Vector3f::Constant(0.5f * kKnot * rope.thickness);
  return {box.min() - reach, box.max() + reach};
}

void RopeDrawing::append(std::span<const ShownRope<3>> ropes, const Vector3f& down,
                         std::vector<render::StaticDraw>& statics) {
  if (ropes.empty()) return;
  SC_ASSERT(std::abs(down.norm() - 1) < 1e-3f, "ropes sag along a direction {} long", down.norm());
  if (!has_meshes_) {
    const auto add = [&](const ppu::TriangleMesh& mesh) {
      return renderer_.add_static_mesh(mesh.positions, mesh.normals, mesh.triangles);
    };
    cylinder_ = add(ppu::make_cylinder(1, 1, 12));
    ball_ = add(ppu::make_sphere(1, 4));
    has_meshes_ = true;
  }
  for (const ShownRope<3>& rope : ropes) {
    const Vector3f& from = rope.ends[0];
    const Vector3f way = rope.ends[1] - from;
    const float distance = way.norm(), radius = 0.5f * rope.thickness;
    const float sag = rope_sag(distance, rope.length);
    const int segments = sag > 0 ? kRopeSegments : 1;
    const auto point = [&](int i) {
      const float share = static_cast<float>(i) / static_cast<float>(segments);
      return Vector3f(from + share * way + 4 * sag * share * (1 - share) * down);
    };
    render::StaticDraw draw{.mesh = cylinder_, .colour = rope.colour};
    for (int i = 0; i < segments; ++i) {
      const Vector3f a = point(i), along = point(i + 1) - a;
      if (!(along.norm() > 0)) continue;
      const Vector3f side = along.unitOrthogonal();
      draw.mesh = cylinder_;
      draw.pose.topLeftCorner<3, 3>() << radius * along.normalized().cross(side), along, radius * side;
      draw.pose.topRightCorner<3, 1>() = a + 0.5f * along;
      statics.push_back(draw);
    }
    draw.mesh = ball_;  // for joints, and for the knots at both ends
    for (int i = 0; i <= segments; ++i) {
      const float size = i == 0 || i == segments ? kKnot * radius : radius;
      draw.pose.topLeftCorner<3, 3>() = size * Eigen::Matrix3f::Identity();
      draw.pose.topRightCorner<3, 1>() = point(i);
      statics.push_back(draw);
    }
  }
}

}  // namespace softcell::demos
