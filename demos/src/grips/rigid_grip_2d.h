#pragma once
// A hand's hold on a rigid body in two dimensions, at one of its points.

#include <Eigen/Core>

#include "grip.h"

class b2Body;

namespace softcell::demos {

/// One thread uses it.
class RigidGrip2d final : public Grip<2> {
 public:
  /// @param body   is dynamic, and must outlive this object  @param point  metres, in the world
  RigidGrip2d(b2Body& body, const Eigen::Vector2f& point);

  Eigen::Vector2f point() const override;
  void pull(const HandMotion<2>& hand, const Eigen::Vector2f& gravity, float step) override;
  void let_go(const Eigen::Vector2f& velocity) override;

 private:
  b2Body& body_;
  Eigen::Vector2f place_;  // of the held point, in the body's frame
};

}  // namespace softcell::demos
