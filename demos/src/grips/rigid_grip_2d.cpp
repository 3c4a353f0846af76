#include "rigid_grip_2d.h"

#include <box2d/b2_body.h>
#include <box2d/b2_fixture.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector2f;

Vector2d cross(double omega, const Vector2d& r) { return omega * Vector2d(-r.y(), r.x()); }
b2Vec2 to_box2d_vector(const Vector2f& v) { return {v.x(), v.y()}; }
Vector2f from_box2d(const b2Vec2& v) { return {v.x, v.y}; }

/// Moves a point into the body's box: a recording may name any point, but no hand may hold a body by a point outside of it.
Vector2f near_body_2d(const b2Body& body, const Vector2f& point) {
  Eigen::AlignedBox2f box;
  for (const b2Fixture* fixture = body.GetFixtureList(); fixture != nullptr; fixture = fixture->GetNext()) {
    box.extend(from_box2d(fixture->GetAABB(0).lowerBound));
    box.extend(from_box2d(fixture->GetAABB(0).upperBound));
  }
  return point.cwiseMax(box.min()).cwiseMin(box.max());
}

}  // namespace

RigidGrip2d::RigidGrip2d(b2Body& body, const Vector2f& point)
    : body_(body), place_(from_box2d(body.GetLocalPoint(to_box2d_vector(near_body_2d(body, point))))) {
  SC_ASSERT(point.allFinite() && body.GetMass() > 0 && body.GetInertia() > 0,
            "a body of {} kg and {} kg m^2 is held at ({}, {})", body.GetMass(), body.GetInertia(), point.x(),
            point.y());
}

Vector2f RigidGrip2d::point() const { return from_box2d(body_.GetWorldPoint(to_box2d_vector(place_))); }

void RigidGrip2d::pull(const HandMotion<2>& hand, const Vector2f& gravity, float step) {
  using Strength = HandStrength<2>;
  const double h = double{step}, most = h * Strength::most_acceleration(gravity),
               damped = Strength::damped_share(h);
  const Vector2d at = point().cast<double>();
  const Vector2d arm = at - from_box2d(body_.GetWorldCenter()).cast<double>();
  const Vector2d velocity = from_box2d(body_.GetLinearVelocity()).cast<double>();
  const double spin = double{body_.GetAngularVelocity()}, mass = double{body_.GetMass()};
  // GetInertia() is about the body's origin. [b2_body.h, GetInertia] documented
  const double inertia =
      double{body_.GetInertia()} - mass * from_box2d(body_.GetLocalCenter()).cast<double>().squaredNorm();

  const Vector2d drag = Strength::limited(damped * (hand.velocity.cast<double>() - velocity), most);
  const double slower = (1 - damped) * spin;
  const Vector2d change = Strength::wanted_velocity(hand, at) - (velocity + drag + cross(slower, arm)) -
                          h * gravity.cast<double>();
  const Vector2d across(-arm.y(), arm.x());
  const Matrix2d response = Matrix2d::Identity() / mass + across * across.transpose() / inertia;
  const Vector2d impulse = Strength::limited(response.inverse() * change, most * mass);

  body_.SetLinearVelocity(to_box2d_vector((velocity + drag + impulse / mass).cast<float>()));
  body_.SetAngularVelocity(static_cast<float>(slower + across.dot(impulse) / inertia));
}

void RigidGrip2d::let_go(const Vector2f& velocity) {
  const Vector2d now = from_box2d(body_.GetLinearVelocity()).cast<double>();
  const Vector2d thrown = now + HandStrength<2>::throw_aid(velocity.cast<double>(), now);
  body_.SetLinearVelocity(to_box2d_vector(thrown.cast<float>()));
}

}  // namespace softcell::demos
