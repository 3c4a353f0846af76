// Rigid bodies that hang from joints, under soft ones.

#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "contact_world.h"
#include "ppu/bullet/joint_rows.h"
#include "ppu/numbers/skyline_factor.h"
#include "ppu/supports/supports.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kJointCells = 0.1f;

TEST(SkylineFactor, SolvesWhatItsMatrixSays) {
  // Of a chain: each row with its neighbours, the last one with all.
  constexpr std::size_t kRows = 7;
  const auto first = [](std::size_t i) { return i == kRows - 1 ? 0 : i - std::min<std::size_t>(i, 1); };
  const auto element = [](std::size_t i, std::size_t j) {
    return i == j ? 5.0 + static_cast<double>(i) : -1.0 / static_cast<double>(1 + j);
  };
  SkylineFactor factor;
  factor.factor(kRows, first, element, [](std::size_t) { return 1e-9; });
  std::vector<double> values(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    for (std::size_t j = 0; j < kRows; ++j) {
      const std::size_t row = std::max(i, j), column = std::min(i, j);
      if (column >= first(row)) values[i] += element(row, column) * static_cast<double>(j + 1);
    }
  }
  factor.solve(values);
  for (std::size_t i = 0; i < kRows; ++i) EXPECT_NEAR(values[i], static_cast<double>(i + 1), 1e-12) << i;
}

/// A plank of 2 kg, with a moment of inertia of 1 kg m^2.
ContactRigid plank() {
  ContactRigid rigid;
  rigid.inverse_mass = 0.5f;
  rigid.inverse_inertia = Eigen::Matrix3f::Identity();
  return rigid;
}

Press from_above(const Vector3f& point, float mass = 1) {
  return {.point = point, .normal = {0, 1, 0}, .mass = mass, .velocity = {0, -1, 0}, .spacing = kJointCells};
}

/// The rows of a hinge at a place, along z.
std::vector<JointRow> hinge_at(const Vector3f& arm) {
  std::vector<JointRow> rows;
  for (const Vector3f& axis : {Vector3f(1, 0, 0), Vector3f(0, 1, 0), Vector3f(0, 0, 1)})
    rows.push_back({.of_a = {axis, arm.cross(axis)}});
  for (const Vector3f& axis : {Vector3f(1, 0, 0), Vector3f(0, 1, 0)})
    rows.push_back({.of_a = {Vector3f::Zero(), axis}});
  return rows;
}

TEST(Joints, AHingeLetsAPlankTurnOnly) {
  std::vector<ContactRigid> rigids = {plank()};
  rigids[0].velocity = {0, -9.81f * kStep, 0};
  Supports supports;
  const Vector3f arm(-0.5f, 0, 0);
  const auto rows = hinge_at(arm);
  const std::vector<Press> presses = {from_above({0.3f, 0, 0})};
  supports.hold(rigids, {.joints = rows}, presses, kStep);
  ASSERT_TRUE(rigids[0].held);
  // About the hinge: 1 kg m^2 and 2 kg at 0.5 m.
  for (const float x : {-0.5f, 0.0f, 0.7f}) {
    const float reach = x + 0.5f;
    EXPECT_NEAR(rigids[0].mobility({x, 0, 0.2f}, {0, 1, 0}), reach * reach / 1.5f, 1e-4f) << x;
  }
  EXPECT_NEAR(rigids[0].mobility({0.7f, 0, 0}, {1, 0, 0}), 0, 1e-4f);
  EXPECT_NEAR(rigids[0].mobility({0.7f, 0, 0}, {0, 0, 1}), 0, 1e-4f);
  // It falls about the hinge, not from it.
  EXPECT_NEAR((rigids[0].velocity + rigids[0].spin.cross(arm)).norm(), 0, 1e-5f);
  EXPECT_NEAR(rigids[0].spin.z(), -9.81f * kStep * 2 * 0.5f / 1.5f, 1e-4f);
}

/// Engines can keep bodies from turning: no row of turning says anything of them.
TEST(Joints, WhatDoesNotTurnIsHeldAsWell) {
  std::vector<ContactRigid> rigids = {plank()};
  rigids[0].inverse_inertia.setZero();
  const auto rows = hinge_at({-0.5f, 0, 0});
  const std::vector<Press> presses = {from_above({0.3f, 0, 0})};
  Supports supports;
  supports.hold(rigids, {.joints = rows}, presses, kStep);
  ASSERT_TRUE(rigids[0].held);
  EXPECT_NEAR(rigids[0].mobility({0.3f, 0, 0}, {0, 1, 0}), 0, 1e-4f);
  supports.add_impulse(0, {0.3f, 0, 0}, {0, -1, 0});
  supports.release();
  EXPECT_TRUE(rigids[0].velocity.allFinite() && rigids[0].spin.allFinite());
  EXPECT_EQ(rigids[0].spin.norm(), 0);
}

/// One that is too weak for a load does what it can, and what it moves goes on as if it were free.
TEST(Joints, AMotorHoldsWhatItIsStrongEnoughFor) {
  JointRow motor{.of_a = {{0, 1, 0}, {0, 0, 0}}, .target = 0.5f};
  struct Held {
    float mobility, speed;
  };
  const auto hold = [&](float strength, float mass) {
    motor.least = -strength, motor.most = strength;
    std::vector<ContactRigid> rigids = {plank()};
    Supports supports;
    const std::vector<JointRow> rows = {motor};
    const std::vector<Press> presses = {from_above({0, 0, 0}, mass)};
    supports.hold(rigids, {.joints = rows}, presses, kStep);
    return Held{rigids[0].mobility({0, 0, 0}, {0, 1, 0}), rigids[0].velocity.y()};
  };
  // It brings 2 kg to 0.5 m/s with 1 kg m/s, and stops 10 kg, which come at 1.5 m/s, with 15.
  EXPECT_NEAR(hold(17, 10).mobility, 0, 1e-4f);
  EXPECT_NEAR(hold(17, 10).speed, 0.5f, 1e-5f);
  EXPECT_NEAR(hold(15, 10).mobility, 0.5f, 1e-4f);
  EXPECT_NEAR(hold(15, 10).speed, 0.5f * 15, 1e-4f);
}

/// A chain of bodies from a hook is held by that: the lowest one cannot fall, however heavy what is on it.
TEST(Joints, AChainHoldsItsLastBody) {
  constexpr std::uint32_t kLinks = 20;
  std::vector<ContactRigid> rigids(kLinks, plank());
  std::vector<JointRow> rows;
  for (std::uint32_t i = 0; i < kLinks; ++i) {
    rigids[i].centre = {0, -static_cast<float>(i), 0};
    for (const Vector3f& axis : {Vector3f(1, 0, 0), Vector3f(0, 1, 0), Vector3f(0, 0, 1)}) {
      const Vector3f up(0, 0.5f, 0);
      JointRow row{.a = i, .of_a = {axis, up.cross(axis)}};
      if (i > 0) row.b = i - 1, row.of_b = {-axis, up.cross(axis)};
      rows.push_back(row);
    }
  }
  Press press = from_above({0, 0.5f - kLinks, 0}, 1000);
  press.rigid = kLinks - 1;
  const std::vector<Press> presses = {press};
  Supports supports;
  supports.hold(rigids, {.joints = rows}, presses, kStep);
  ASSERT_TRUE(rigids[kLinks - 1].held);
  EXPECT_NEAR(rigids[kLinks - 1].mobility(press.point, {0, 1, 0}), 0, 1e-3f);
  EXPECT_GT(rigids[kLinks - 1].mobility(press.point, {1, 0, 0}), 0.1f) << "it swings";
  for (std::uint32_t i = 0; i + 1 < kLinks; ++i) EXPECT_FALSE(rigids[i].held) << i;
}

/// The program that breaks a joint by what it bears, or Bullet itself, sees all of it.
TEST(Joints, WhatIsWatchedIsLeftToItsEngine) {
  for (const bool is_watched : {false, true}) {
    std::vector<ContactRigid> rigids = {plank()};
    std::vector<JointRow> rows = hinge_at({-0.5f, 0, 0});
    for (JointRow& row : rows) row.is_watched = is_watched;
    const std::vector<Press> presses = {from_above({0, 0, 0})};
    Supports supports;
    supports.hold(rigids, {.joints = rows}, presses, kStep);
    ASSERT_TRUE(rigids[0].held);
    supports.add_impulse(0, {0, 0, 0}, {0, -100, 0});
    supports.release();
    // A hinge would take a part of what moves its centre.
    if (is_watched)
      EXPECT_FLOAT_EQ(rigids[0].velocity.y(), -50);
    else
      EXPECT_GT(rigids[0].velocity.y(), -30);
  }
}

/// Planks that hang from joints, below a cube of soft material.
struct UnderACube {
  explicit UnderACube(SolverFactory* solvers) : w({0, -9.81f, 0}, solvers) {
    cube = &w.add(make_box({0.7f, 0.7f, 0.7f}, kJointCells), settings_of(kJointCells, 0.5f, 0.2f),
                  {0.03f, 0.6f, 0.02f});
  }
  ~UnderACube() {
    for (const auto& joint : joints) w.world.removeConstraint(joint.get());
  }
  /// @param mass  of the cube's
  btRigidBody& add_plank(const Vector3f& half, float mass, const Vector3f& at) {
    planks.push_back(
        {&w.add(std::make_unique<btBoxShape>(to_bullet(half)), mass * cube->model().mass(), at, 0.8f), half});
    planks.back().body->setActivationState(DISABLE_DEACTIVATION);
    return *planks.back().body;
  }
  template <typename Joint, typename... Arguments>
  Joint& join(Arguments&&... arguments) {
    auto made = std::make_unique<Joint>(std::forward<Arguments>(arguments)...);
    Joint& joint = *made;
    w.world.addConstraint(&joint, true);
    joints.push_back(std::move(made));
    return joint;
  }
  /// Planks from wall to wall, each pinned to the next one on both sides, hanging a little.
  void add_bridge(int count, float mass) {
    constexpr float kHalf = 0.12f, kGap = 0.01f, kSide = 0.35f;
    std::vector<float> turns;
    Vector3f begin(0, 0, 0), end(0, 0, 0);
    const auto along = [](float turn) { return Vector3f(std::cos(turn), std::sin(turn), 0); };
    for (int i = 0; i < count; ++i) {
      turns.push_back(0.08f * (static_cast<float>(i) - static_cast<float>(count - 1) / 2));
      end += 2 * (kHalf + kGap) * along(turns.back());
    }
    begin = -0.5f * end;
    btRigidBody* before = nullptr;
    for (const float turn : turns) {
      const Vector3f to_middle = (kHalf + kGap) * along(turn);
      btRigidBody& body = add_plank({kHalf, 0.03f, 0.4f}, mass, begin + to_middle);
      btTransform pose = body.getWorldTransform();
      pose.setRotation(btQuaternion(btVector3(0, 0, 1), turn));
      body.setWorldTransform(pose);
      body.setInterpolationWorldTransform(pose);
      w.world.updateSingleAabb(&body);
      for (const float z : {-kSide, kSide}) {
        const btVector3 left(-kHalf - kGap, 0, z), right(kHalf + kGap, 0, z);
        if (before != nullptr)
          join<btPoint2PointConstraint>(*before, body, right, left);
        else
          join<btPoint2PointConstraint>(body, left);
        if (planks.size() == turns.size()) join<btPoint2PointConstraint>(body, right);
      }
      before = &body;
      begin += 2 * to_middle;
    }
  }
  /// Metres, of points of planks in the cube.
  float depth() const {
    const tests::DrawnBody drawn(*cube);
    float most = 0;
    for (const auto& [body, half] : planks)
      for (int i = -4; i <= 4; ++i)
        for (const float y : {-half.y(), half.y()})
          for (const float z : {-half.z(), 0.0f, half.z()}) {
            const btVector3 place(half.x() * static_cast<float>(i) / 4, y, z);
            most = std::max(most, drawn.depth(to_eigen(body->getWorldTransform() * place)));
          }
    return most;
  }
  float deepest(int frames) {
    float most = 0;
    for (int i = 0; i < frames; ++i) {
      w.run(1);
      most = std::max(most, depth());
    }
    return most;
  }
  struct Plank {
    btRigidBody* body;
    Vector3f half;
  };
  ContactWorld w;
  SoftBody<3>* cube = nullptr;
  std::vector<Plank> planks;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
};

class JointsUnderACube : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<UnderACube> scene() {
    if (GetParam() && !spes_) spes_ = std::make_unique<SpeRuntime>();
    return std::make_unique<UnderACube>(spes_.get());
  }

 private:
  std::unique_ptr<SpeRuntime> spes_;
};

/// Plates of a tenth of its mass were three cells deep in it, and it fell through them.
TEST_P(JointsUnderACube, APlateThatHangsInTheWorldCarriesIt) {
  for (const float mass : {1.0f, 0.03f}) {
    const auto s = scene();
    btRigidBody& plate = s->add_plank({0.6f, 0.04f, 0.6f}, mass, {0, 0, 0});
    auto& hold = s->join<btGeneric6DofConstraint>(plate, btTransform::getIdentity(), true);
    for (int axis = 0; axis < 6; ++axis) hold.setLimit(axis, 0, 0);
    EXPECT_LT(s->deepest(90), 0.1f * kJointCells) << mass;
    EXPECT_NEAR(s->cube->centre_of_mass().y(), 0.39f, 0.5f * kJointCells) << mass;
  }
}

TEST_P(JointsUnderACube, ALiftBringsItUp) {
  for (const float mass : {1.0f, 0.03f}) {
    const auto s = scene();
    btRigidBody& plate = s->add_plank({0.6f, 0.04f, 0.6f}, mass, {0, 0, 0});
    btTransform upright = btTransform::getIdentity();
    upright.setRotation(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI));
    auto& lift = s->join<btSliderConstraint>(plate, upright, true);
    lift.setLowerLinLimit(-1);
    lift.setUpperLinLimit(1);
    lift.setLowerAngLimit(0);
    lift.setUpperAngLimit(0);
    lift.setPoweredLinMotor(true);
    lift.setMaxLinMotorForce(100 * s->cube->model().mass());
    lift.setTargetLinMotorVelocity(0.5f);
    EXPECT_LT(s->deepest(100), 0.15f * kJointCells) << mass;
    EXPECT_NEAR(plate.getWorldTransform().getOrigin().y(), 0.5f * 100 / 60, 0.05f) << mass;
    EXPECT_NEAR(s->cube->centre_of_mass().y() - plate.getWorldTransform().getOrigin().y(), 0.39f,
                0.5f * kJointCells)
        << mass;
  }
}

/// Bullet applies a spring's force by itself: if softcell applied it as well, the spring would carry the cube at four fifths of its way.
/// Bullet's damper also sees the velocity which the load gives the plate within a substep: here that is 2 % of the way.
TEST_P(JointsUnderACube, ASpringActsAsStrongly) {
  const auto s = scene();
  btRigidBody& plate = s->add_plank({0.6f, 0.04f, 0.6f}, 0.5f, {0, 0, 0});
  auto& spring = s->join<btGeneric6DofSpring2Constraint>(plate, btTransform::getIdentity());
  spring.setLinearLowerLimit({0, 1, 0});
  spring.setLinearUpperLimit({0, -1, 0});
  spring.setAngularLowerLimit({0, 0, 0});
  spring.setAngularUpperLimit({0, 0, 0});
  const float mass = 1.5f * s->cube->model().mass();
  spring.enableSpring(1, true);
  spring.setStiffness(1, mass * 9.81f / 0.1f, false);
  spring.setDamping(1, mass, false);
  spring.setEquilibriumPoint(1, 0);
  s->w.run(400);
  EXPECT_NEAR(plate.getWorldTransform().getOrigin().y(), -0.1f, 0.05f * 0.1f);
}

/// It throws nothing into the air either.
TEST_P(JointsUnderACube, ABridgeOfPlanksCarriesIt) {
  for (const float mass : {1.0f, 0.1f}) {
    const auto s = scene();
    s->add_bridge(8, mass);
    EXPECT_LT(s->deepest(60), 0.3f * kJointCells) << mass;
    float highest = -1;
    for (int i = 0; i < 120; ++i) {
      s->w.run(1);
      highest = std::max(highest, s->cube->centre_of_mass().y());
    }
    EXPECT_LT(highest, 0.6f) << "it fell from there, " << mass;
    EXPECT_GT(s->cube->centre_of_mass().y(), -0.1f) << mass;
    EXPECT_LT(s->depth(), 0.15f * kJointCells) << mass;
  }
}

/// On wheels that are joined to what it lies on, and touch the floor: joints and touches in one set.
TEST_P(JointsUnderACube, ACarCarriesIt) {
  const auto s = scene();
  constexpr float kMass = 0.05f;
  s->w.add(std::make_unique<btBoxShape>(btVector3(50, 1, 50)), 0, {0, -1.3f, 0}, 1);
  btRigidBody& chassis = s->add_plank({0.6f, 0.05f, 0.5f}, kMass, {0, 0, 0});
  for (const float x : {-0.45f, 0.45f})
    for (const float z : {-0.6f, 0.6f}) {
      btRigidBody& wheel = s->w.add(std::make_unique<btSphereShape>(0.15f),
                                    0.2f * kMass * s->cube->model().mass(), {x, -0.15f, z}, 1);
      wheel.setActivationState(DISABLE_DEACTIVATION);
      const btVector3 axis(0, 0, 1);
      s->join<btHingeConstraint>(chassis, wheel, btVector3(x, -0.15f, z), btVector3(0, 0, 0), axis, axis);
    }
  EXPECT_LT(s->deepest(120), 0.15f * kJointCells);
  EXPECT_NEAR(chassis.getWorldTransform().getOrigin().y(), 0, 0.02f);
}

INSTANTIATE_TEST_SUITE_P(Solvers, JointsUnderACube, testing::Bool(),
                         [](const auto& solvers) { return solvers.param ? "Spes" : "Ppu"; });

/// A plate that one joint wants here and others there, one of them with feedback: nothing is thrown out.
TEST(Joints, ThatContradictEachOtherThrowNothing) {
  UnderACube s(nullptr);
  btRigidBody& plate = s.add_plank({0.6f, 0.04f, 0.6f}, 0.05f, {0, 0, 0});
  const btVector3 axis(0, 0, 1);
  s.join<btPoint2PointConstraint>(plate, btVector3(0.5f, 0, 0)).setPivotB({0.52f, 0.01f, 0});
  s.join<btPoint2PointConstraint>(plate, btVector3(-0.5f, 0, 0)).setPivotB({-0.53f, 0, 0.01f});
  s.join<btHingeConstraint>(plate, btVector3(0.1f, 0, 0), axis).enableFeedback(true);
  auto& slider = s.join<btSliderConstraint>(plate, btTransform::getIdentity(), true);
  slider.setLowerLinLimit(0.01f);
  slider.setUpperLinLimit(0.02f);
  float fastest = 0;
  for (int frame = 0; frame < 120; ++frame) {
    s.w.run(1);
    fastest = std::max({fastest, float{plate.getLinearVelocity().length()}, ContactWorld::fastest(*s.cube)});
  }
  EXPECT_LT(fastest, 12);
}

/// A plate of the cube's mass, which a joint fixes to the world.
btGeneric6DofConstraint& fix_a_plate(UnderACube& s) {
  btRigidBody& plate = s.add_plank({0.6f, 0.04f, 0.6f}, 1, {0, 0, 0});
  auto& fixed = s.join<btGeneric6DofConstraint>(plate, btTransform::getIdentity(), true);
  for (int axis = 0; axis < 6; ++axis) fixed.setLimit(axis, 0, 0);
  return fixed;
}

TEST(Joints, OneThatSaysWhatItBearsBearsASoftBody) {
  UnderACube s(nullptr);
  btGeneric6DofConstraint& fixed = fix_a_plate(s);
  btJointFeedback feedback;
  fixed.enableFeedback(true);
  fixed.setJointFeedback(&feedback);
  s.w.run(60);
  double force = 0;
  constexpr int kFrames = 60;
  for (int i = 0; i < kFrames; ++i) {
    s.w.run(1);
    force += double{feedback.m_appliedForceBodyA.y()} / kFrames;
  }
  EXPECT_NEAR(force / (double{s.cube->model().mass()} * 9.81), -2, 0.05) << "of both";
}

/// Bullet breaks it as under a rigid body. When the cube comes down it bears four times the weight of one.
TEST(Joints, OneThatBreaksBreaksUnderASoftBody) {
  for (const float strength : {3.0f, 30.0f}) {
    UnderACube s(nullptr);
    btGeneric6DofConstraint& fixed = fix_a_plate(s);
    fixed.setBreakingImpulseThreshold(strength * s.cube->model().mass() * 9.81f * kStep);
    s.w.run(5);
    EXPECT_TRUE(fixed.isEnabled()) << "the cube is in the air yet";
    s.w.run(55);
    EXPECT_EQ(fixed.isEnabled(), strength > 4) << strength;
  }
}

/// The rows of all kinds of Bullet's joints say what Bullet makes of velocities.
TEST(JointRows, AreThoseOfAHinge) {
  btBoxShape box(btVector3(0.5f, 0.1f, 0.1f));
  btVector3 inertia;
  box.calculateLocalInertia(2, inertia);
  btRigidBody a(2, nullptr, &box, inertia), b(2, nullptr, &box, inertia);
  b.translate({1.2f, 0, 0});
  btHingeConstraint hinge(a, b, btVector3(0.6f, 0, 0), btVector3(-0.6f, 0, 0), btVector3(0, 0, 1),
                          btVector3(0, 0, 1));
  const btContactSolverInfo info;
  std::vector<JointRow> rows;
  add_joint_rows(hinge, 3, 5, info, kStep, rows);
  ASSERT_EQ(rows.size(), 5u);
  const auto speed = [](const JointRow& row, const Vector3f& va, const Vector3f& wa, const Vector3f& vb,
                        const Vector3f& wb) {
    return row.of_a.linear.dot(va) + row.of_a.angular.dot(wa) + row.of_b.linear.dot(vb) +
           row.of_b.angular.dot(wb);
  };
  const Vector3f none(0, 0, 0), spin(0, 0, 2);
  for (const JointRow& row : rows) {
    EXPECT_EQ(row.a, 3u);
    EXPECT_EQ(row.b, 5u);
    EXPECT_FALSE(row.is_limited());
    EXPECT_NEAR(row.target, 0, 1e-6f);
    // Around the pin they may turn against each other, and together they may move.
    EXPECT_NEAR(speed(row, none, none, -spin.cross(Vector3f(-0.6f, 0, 0)), spin), 0, 1e-5f);
    EXPECT_NEAR(speed(row, {1, 2, 3}, none, {1, 2, 3}, none), 0, 1e-5f);
  }
  float apart = 0;
  for (const JointRow& row : rows) apart = std::max(apart, std::abs(speed(row, none, none, {0, 1, 0}, none)));
  EXPECT_NEAR(apart, 1, 1e-5f);
  hinge.enableAngularMotor(true, 3, 0.7f);
  rows.clear();
  add_joint_rows(hinge, 3, 5, info, kStep, rows);
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_TRUE(rows[5].is_limited());
  EXPECT_FLOAT_EQ(rows[5].most, 0.7f);
  EXPECT_FLOAT_EQ(std::abs(rows[5].target), 3);
  EXPECT_FALSE(rows[5].is_watched);
  hinge.setBreakingImpulseThreshold(1);
  rows.clear();
  add_joint_rows(hinge, 3, JointRow::kWorld, info, kStep, rows);
  EXPECT_TRUE(rows[0].is_watched);
}

/// Bullet has rows of both ends of a range: in between things may go on to either, and beyond one they are held.
TEST(JointRows, AreThoseOfARange) {
  btBoxShape box(btVector3(0.5f, 0.1f, 0.1f));
  btRigidBody body(2, nullptr, &box, {1, 1, 1});
  btGeneric6DofSpring2Constraint range(body, btTransform::getIdentity());
  for (int axis = 0; axis < 6; ++axis) range.setLimit(axis, 0, 0);
  range.setLimit(1, -0.5f, 0.5f);
  const btContactSolverInfo info;
  const auto fastest = [&](float height, float direction) {
    body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, height, 0)));
    body.setCenterOfMassTransform(body.getWorldTransform());
    std::vector<JointRow> rows;
    add_joint_rows(range, JointRow::kWorld, 0, info, kStep, rows);
    float speed = 1e9f;
    for (const JointRow& row : rows) {
      if (!row.is_limited()) continue;
      const float share = direction * row.of_b.linear.y();
      const bool stops = share > 0 ? row.least < 0 : row.most > 0;
      if (stops) speed = std::min(speed, row.target / share);
    }
    return speed;
  };
  EXPECT_GT(fastest(0, 1), 5);
  EXPECT_GT(fastest(0, -1), 5);
  EXPECT_EQ(fastest(0.51f, 1), 0);
  EXPECT_GT(fastest(0.51f, -1), 5);
}

}  // namespace
}  // namespace softcell::ppu
