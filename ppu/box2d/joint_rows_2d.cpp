#include "ppu/box2d/joint_rows_2d.h"

#include <box2d/b2_body.h>
#include <box2d/b2_distance_joint.h>
#include <box2d/b2_prismatic_joint.h>
#include <box2d/b2_pulley_joint.h>
#include <box2d/b2_revolute_joint.h>
#include <box2d/b2_weld_joint.h>
#include <box2d/b2_wheel_joint.h>

#include <algorithm>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

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
    for (const b2Vec2 axis : {b2Vec2(1, 0), b2Vec2(0, 1)})
      add({.of_a = share(axis, arm_a_, -1), .of_b = share(axis, arm_b_, 1)});
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
  void add_motor(JointRow row, float speed, float force) {
    row.target = speed;
    row.least = -step_ * force, row.most = step_ * force;
    add(row);
  }
  /// Box2D's soft constraint: a spring with a stiffness and a damping, at a position error.
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
    case e_pulleyJoint:
      return add_rows(static_cast<b2PulleyJoint&>(joint), made);
    default:
      return;
  }
}

}  // namespace softcell::ppu
