#include "moved_2d.h"

#include <algorithm>
#include <variant>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

struct RadiusOf {
  float operator()(const Box2dShape& box) const { return box.size.norm() / 2; }
  float operator()(const CircleShape& circle) const { return circle.radius; }
  float operator()(const PolygonShape& polygon) const {
    float radius = 0;
    for (const Eigen::Vector2f& corner : polygon.corners) radius = std::max(radius, corner.norm());
    return radius;
  }
};

void extend(Moved2d::Box& box, const Eigen::Vector2f& centre, float radius) {
  SC_ASSERT(radius >= 0, "{} m around ({}, {})", radius, centre.x(), centre.y());
  box.extend(centre - Eigen::Vector2f::Constant(radius));
  box.extend(centre + Eigen::Vector2f::Constant(radius));
}

}  // namespace

Moved2d::Moved2d(const Scene2d& scene) : poses_(scene.rigid_bodies.size()) {
  for (const RigidBody2d& body : scene.rigid_bodies) radii_.push_back(std::visit(RadiusOf{}, body.shape));
}

Moved2d::Box Moved2d::since_last(const Shown2d& now, const Box& soft_bodies) {
  SC_ASSERT(now.rigid_poses.size() == poses_.size(), "{} rigid bodies of another scene than {}",
            now.rigid_poses.size(), poses_.size());
  Box restless_now = soft_bodies;
  for (const auto& [particle, hand] : now.hands) {
    restless_now.extend(particle);
    restless_now.extend(hand);
  }
  Box moved = restless_.merged(restless_now);
  restless_ = restless_now;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (poses_[i] == now.rigid_poses[i]) continue;
    for (const Pose2d& pose : {poses_[i], now.rigid_poses[i]}) extend(moved, pose.position, radii_[i]);
    poses_[i] = now.rigid_poses[i];
  }
  return moved;
}

}  // namespace softcell::demos
