#include "rigid_grip.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "ppu/bullet/bullet_vector.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

/// Moves a point into the body's box: a recording may name any point, but no hand may hold a body by a point outside of it.
Vector3f near_body(const btRigidBody& body, const Vector3f& point) {
  btVector3 low, high;
  body.getAabb(low, high);
  return point.cwiseMax(ppu::to_eigen(low)).cwiseMin(ppu::to_eigen(high));
}

}  // namespace

RigidGrip::RigidGrip(btRigidBody& body, const Vector3f& point)
    : body_(body),
      place_(ppu::to_eigen(body.getWorldTransform().inverse() * ppu::to_bullet(near_body(body, point)))) {
  SC_ASSERT(point.allFinite() && body.getInvMass() > 0,
            "a body with an inverse mass of {} is held at ({}, {}, {})", body.getInvMass(), point.x(),
            point.y(), point.z());
}

Vector3f RigidGrip::point() const {
  return ppu::to_eigen(body_.getWorldTransform() * ppu::to_bullet(place_));
}

void RigidGrip::pull(const HandMotion<3>& hand, const Vector3f& gravity, float step) {
  using Strength = HandStrength<3>;
  const double h = double{step}, most = h * Strength::most_acceleration(gravity),
               damped = Strength::damped_share(h);
  const Vector3d at = point().cast<double>();
  const Vector3d arm = at - ppu::to_eigen(body_.getCenterOfMassPosition()).cast<double>();
  const Vector3d velocity = ppu::to_eigen(body_.getLinearVelocity()).cast<double>();
  const Vector3d spin = ppu::to_eigen(body_.getAngularVelocity()).cast<double>();

  const Vector3d drag = Strength::limited(damped * (hand.velocity.cast<double>() - velocity), most);
  const Vector3d slow_down = -damped * spin;
  const Vector3d now = velocity + drag + (spin + slow_down).cross(arm);

  const btMatrix3x3& inverse = body_.getInvInertiaTensorWorld();
  Matrix3d inverse_inertia, cross;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) inverse_inertia(i, j) = double{inverse[i][j]};
  cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  const double inverse_mass = double{body_.getInvMass()};
  const Matrix3d response = inverse_mass * Matrix3d::Identity() - cross * inverse_inertia * cross;
  const Vector3d change = Strength::wanted_velocity(hand, at) - now - h * gravity.cast<double>();
  const Vector3d impulse = Strength::limited(response.inverse() * change, most / inverse_mass);

  const Vector3d linear = velocity + drag + inverse_mass * impulse;
  const Vector3d angular = spin + slow_down + inverse_inertia * arm.cross(impulse);
  body_.setLinearVelocity(ppu::to_bullet(linear.cast<float>()));
  body_.setAngularVelocity(ppu::to_bullet(angular.cast<float>()));
}

void RigidGrip::let_go(const Vector3f& velocity) {
  const Vector3d now = ppu::to_eigen(body_.getLinearVelocity()).cast<double>();
  const Vector3d thrown = now + HandStrength<3>::throw_aid(velocity.cast<double>(), now);
  body_.setLinearVelocity(ppu::to_bullet(thrown.cast<float>()));
}

}  // namespace softcell::demos
