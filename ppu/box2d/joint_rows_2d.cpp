#include "ppu/box2d/joint_rows_2d.h"

#include <box2d/b2_body.h>
#include <box2d/b2_distance_joint.h>
#include <box2d/b2_friction_joint.h>
#include <box2d/b2_motor_joint.h>
#include <box2d/b2_mouse_joint.h>
#include <box2d/b2_prismatic_joint.h>
#include <box2d/b2_pulley_joint.h>
#include <box2d/b2_revolute_joint.h>
#include <box2d/b2_weld_joint.h>
#include <box2d/b2_wheel_joint.h>

#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

const b2Vec2 kAxes[] = {{1, 0}, {0, 1}};

/// Writes the rows of one joint: its second body against its first one.
class Rows {
 public:
  Rows(b2Joint& joint, std::uint32_t a, std::uint32_t b, float step, std::vector<JointRow>& rows)
      : index_a_(a),
        index_b_(b),
        step_(step),
        rows_(rows),
        at_b_(joint.GetAnchorB()),
        arm_a_(joint.GetAnchorA() - joint.GetBodyA()->GetWorldCenter()),
        arm_b_(at_b_ - joint.GetBodyB()->GetWorldCenter()),
        reach_a_(at_b_ - joint.GetBodyA()->GetWorldCenter()) {}

  /// Keeps the two anchors together.
  void pin() {
    for (const b2Vec2& axis : kAxes) add(between_anchors(axis));
  }
  /// The motion of the second anchor against the first one.
  JointRow between_anchors(const b2Vec2& axis) const {
    return {.of_a = share(axis, arm_a_, -1), .of_b = share(axis, arm_b_, 1)};
  }
  /// Moves the second anchor relative to the first body.
  JointRow along(const b2Vec2& axis) const {
    return {.of_a = share(axis, reach_a_, -1), .of_b = share(axis, arm_b_, 1)};
  }
  static JointRow turning() { return {.of_a = {{0, 0, 0}, {0, 0, -1}}, .of_b = {{0, 0, 0}, {0, 0, 1}}}; }

  void add(JointRow row) {
    row.a = index_a_, row.b = index_b_;
    rows_.push_back(row);
  }
  void limit(JointRow& row, float force) const { row.least = -step_ * force, row.most = step_ * force; }
  void add_motor(JointRow row, float speed, float force) {
    row.target = speed;
    limit(row, force);
    add(row);
  }
  float step() const { return step_; }
  /// Box2D's soft constraint: a spring with a stiffness and a damping, at a position error. Limits of the row stay.
  void add_spring(JointRow row, float error, float stiffness, float damping) {
    const float gives_way = step_ * (damping + step_ * stiffness);
    if (!(gives_way > 0)) return;
    row.softness = 1 / gives_way;
    row.target = -error * step_ * stiffness / gives_way;
    add(row);
  }
  /// Limits the motion from the present place to `back` backwards and `on` forwards. @param on  infinite: no limit
  void add_limits(JointRow row, float back, float on) {
    row.least = 0;
    row.target = -std::max(0.0f, back) / step_;
    add(row);
    for (JointRow::Share* const share : {&row.of_a, &row.of_b})
      share->linear = -share->linear, share->angular = -share->angular;
    row.target = -std::max(0.0f, on) / step_;
    add(row);
  }
  static JointRow::Share share(const b2Vec2& axis, const b2Vec2& arm, float sign) {
    return {{sign * axis.x, sign * axis.y, 0}, {0, 0, sign * b2Cross(arm, axis)}};
  }

 private:
  std::uint32_t index_a_, index_b_;
  float step_;
  std::vector<JointRow>& rows_;
  b2Vec2 at_b_, arm_a_, arm_b_;
  b2Vec2 reach_a_;  // from the first body's centre to the second anchor
};

void add_rows(b2RevoluteJoint& joint, Rows& rows) {
  rows.pin();
  const float angle = joint.GetJointAngle();
  if (joint.IsMotorEnabled())
    rows.add_motor(Rows::turning(), joint.GetMotorSpeed(), joint.GetMaxMotorTorque());
  if (joint.IsLimitEnabled())
    rows.add_limits(Rows::turning(), angle - joint.GetLowerLimit(), joint.GetUpperLimit() - angle);
}

void add_rows(b2WeldJoint& joint, Rows& rows) {
  rows.pin();
  const float error = joint.GetBodyB()->GetAngle() - joint.GetBodyA()->GetAngle() - joint.GetReferenceAngle();
  if (joint.GetStiffness() > 0)
    rows.add_spring(Rows::turning(), error, joint.GetStiffness(), joint.GetDamping());
  else
    rows.add(Rows::turning());
}

void add_rows(b2PrismaticJoint& joint, Rows& rows) {
  const b2Vec2 axis = joint.GetBodyA()->GetWorldVector(joint.GetLocalAxisA());
  rows.add(rows.along(b2Cross(1, axis)));
  rows.add(Rows::turning());
  const JointRow along = rows.along(axis);
  const float way = joint.GetJointTranslation();
  if (joint.IsMotorEnabled()) rows.add_motor(along, joint.GetMotorSpeed(), joint.GetMaxMotorForce());
  if (joint.IsLimitEnabled())
    rows.add_limits(along, way - joint.GetLowerLimit(), joint.GetUpperLimit() - way);
}

void add_rows(b2WheelJoint& joint, Rows& rows) {
  const b2Vec2 axis = joint.GetBodyA()->GetWorldVector(joint.GetLocalAxisA());
  rows.add(rows.along(b2Cross(1, axis)));
  const JointRow along = rows.along(axis);
  const float way = joint.GetJointTranslation();
  rows.add_spring(along, way, joint.GetStiffness(), joint.GetDamping());
  if (joint.IsLimitEnabled())
    rows.add_limits(along, way - joint.GetLowerLimit(), joint.GetUpperLimit() - way);
  if (joint.IsMotorEnabled())
    rows.add_motor(Rows::turning(), joint.GetMotorSpeed(), joint.GetMaxMotorTorque());
}

void add_rows(b2DistanceJoint& joint, Rows& rows) {
  b2Vec2 axis = joint.GetAnchorB() - joint.GetAnchorA();
  const float length = axis.Normalize();
  if (!(length > 0)) return;
  const JointRow along = rows.along(axis);
  if (joint.GetMinLength() >= joint.GetMaxLength()) {
    rows.add(along);
    return;
  }
  rows.add_spring(along, length - joint.GetLength(), joint.GetStiffness(), joint.GetDamping());
  rows.add_limits(along, length - joint.GetMinLength(), joint.GetMaxLength() - length);
}

/// The greatest force along an axis of a joint that limits the length of its force. If the joint pulls with all of it, towards the place
/// that it aims at, the force across is as small.
/// @param wanted  N: with which the joint would pull if it could
float most_along(const b2Vec2& axis, const b2Vec2& wanted, float most) {
  const float length = wanted.Length();
  return length > most ? most * std::abs(b2Dot(axis, wanted)) / length : most;
}

/// A spring to the mouse, no stronger than the joint's force.
void add_rows(b2MouseJoint& joint, Rows& rows) {
  const b2Vec2 error = joint.GetAnchorB() - joint.GetTarget(), wanted = joint.GetStiffness() * error;
  for (const b2Vec2& axis : kAxes) {
    JointRow row = rows.between_anchors(axis);
    row.of_a = {};
    rows.limit(row, most_along(axis, wanted, joint.GetMaxForce()));
    rows.add_spring(row, b2Dot(axis, error), joint.GetStiffness(), joint.GetDamping());
  }
}

/// Aims at a pose of the second body in the frame of the first one.
void add_rows(b2MotorJoint& joint, Rows& rows) {
  const b2Body &a = *joint.GetBodyA(), &b = *joint.GetBodyB();
  const b2Vec2 error = b.GetPosition() - a.GetWorldPoint(joint.GetLinearOffset());
  const float per_step = joint.GetCorrectionFactor() / rows.step();
  const b2Vec2 wanted = b.GetMass() * per_step / rows.step() * error;
  for (const b2Vec2& axis : kAxes)
    rows.add_motor(rows.along(axis), -per_step * b2Dot(axis, error),
                   most_along(axis, wanted, joint.GetMaxForce()));
  const float turned = b.GetAngle() - a.GetAngle() - joint.GetAngularOffset();
  rows.add_motor(Rows::turning(), -per_step * turned, joint.GetMaxTorque());
}

void add_rows(b2FrictionJoint& joint, Rows& rows) {
  for (const b2Vec2& axis : kAxes) rows.add_motor(rows.between_anchors(axis), 0, joint.GetMaxForce());
  rows.add_motor(Rows::turning(), 0, joint.GetMaxTorque());
}

/// Ropes from two anchors over two pulleys: one gets longer by as much as the other gets shorter.
void add_rows(b2PulleyJoint& joint, Rows& rows) {
  b2Vec2 rope_a = joint.GetAnchorA() - joint.GetGroundAnchorA();
  b2Vec2 rope_b = joint.GetAnchorB() - joint.GetGroundAnchorB();
  if (!(rope_a.Normalize() > 0) || !(rope_b.Normalize() > 0)) return;
  const b2Vec2 arm_a = joint.GetAnchorA() - joint.GetBodyA()->GetWorldCenter();
  const b2Vec2 arm_b = joint.GetAnchorB() - joint.GetBodyB()->GetWorldCenter();
  rows.add({.of_a = Rows::share(rope_a, arm_a, -1), .of_b = Rows::share(rope_b, arm_b, -joint.GetRatio())});
}

}  // namespace

void add_joint_rows(b2Joint& joint, std::uint32_t a, std::uint32_t b, float step,
                    std::vector<JointRow>& rows) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  Rows made(joint, a, b, step, rows);
  switch (joint.GetType()) {
    case e_revoluteJoint:
      return add_rows(static_cast<b2RevoluteJoint&>(joint), made);
    case e_prismaticJoint:
      return add_rows(static_cast<b2PrismaticJoint&>(joint), made);
    case e_wheelJoint:
      return add_rows(static_cast<b2WheelJoint&>(joint), made);
    case e_weldJoint:
      return add_rows(static_cast<b2WeldJoint&>(joint), made);
    case e_distanceJoint:
      return add_rows(static_cast<b2DistanceJoint&>(joint), made);
    case e_mouseJoint:
      return add_rows(static_cast<b2MouseJoint&>(joint), made);
    case e_motorJoint:
      return add_rows(static_cast<b2MotorJoint&>(joint), made);
    case e_frictionJoint:
      return add_rows(static_cast<b2FrictionJoint&>(joint), made);
    case e_pulleyJoint:
      return add_rows(static_cast<b2PulleyJoint&>(joint), made);
    default:
      return;
  }
}

}  // namespace softcell::ppu
