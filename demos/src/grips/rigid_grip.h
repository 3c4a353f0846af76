#pragma once
// A hand's hold on a rigid body, at one of its points.

#include <Eigen/Core>

#include "grip.h"

class btRigidBody;

namespace softcell::demos {

/// One thread uses it.
class RigidGrip final : public Grip<3> {
 public:
  /// @param body   is dynamic, and must outlive this object  @param point  metres, in the world
  RigidGrip(btRigidBody& body, const Eigen::Vector3f& point);

  Eigen::Vector3f point() const override;
  void pull(const HandMotion<3>& hand, const Eigen::Vector3f& gravity, float step) override;
  void let_go(const Eigen::Vector3f& velocity) override;

 private:
  btRigidBody& body_;
  Eigen::Vector3f place_;  // of the held point, in the body's frame
};

}  // namespace softcell::demos
