// Rigid bodies that hang from Box2D's joints, under soft ones.

#include <box2d/b2_circle_shape.h>
#include <box2d/b2_distance_joint.h>
#include <box2d/b2_prismatic_joint.h>
#include <box2d/b2_pulley_joint.h>
#include <box2d/b2_revolute_joint.h>
#include <box2d/b2_weld_joint.h>
#include <box2d/b2_wheel_joint.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "../soft_body_2d_scenes.h"
#include "drawn_flat.h"
#include "ppu/box2d/joint_rows_2d.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kFlatCell = 0.25f;
constexpr float kFlatStep = 1.0f / 120;

/// A soft block above planks.
struct UnderABlock {
  UnderABlock(float gravity, SolverFactory* spes)
      : w(spes != nullptr ? std::make_unique<World2d>(gravity, ContactMethod::kSurface, *spes)
                          : std::make_unique<World2d>(gravity, ContactMethod::kSurface)),
        ground(*w->add_box({0, -30}, {1, 1})),
        block(w->soft.add(
            rectangle_model(
                {8, 6},
                {.cell_size = kFlatCell, .half_width = 2, .density = 5, .alpha = 0.5f, .damping = 0.3f}),
            {-0.05f, 1.3f})) {}
  /// @param mass  of the block's
  b2Body& add_plank(const b2Vec2& at, const b2Vec2& half, float mass) {
    planks.push_back({w->add_box(at, half, mass * block.model().mass() / (4 * half.x * half.y)), half});
    return *planks.back().body;
  }
  /// A joint of a plank, at one of its points; Definition::Initialize() has two bodies, and then what is given.
  template <typename Definition, typename... Arguments>
  void join(b2Body& a, b2Body& b, const Arguments&... arguments) {
    Definition definition;
    definition.Initialize(&a, &b, arguments...);
    w->box2d.CreateJoint(&definition);
  }
  float deepest(int frames) {
    float most = 0;
    for (int frame = 0; frame < frames; ++frame) {
      w->run(1.0f / 60);
      std::vector<Vector2f> places;
      for (const auto& [body, half] : planks)
        for (int i = -6; i <= 6; ++i)
          for (const float y : {-half.y, half.y}) {
            const b2Vec2 place = body->GetWorldPoint({half.x * static_cast<float>(i) / 6, y});
            places.emplace_back(place.x, place.y);
          }
      most = std::max(most, drawn.depth(places));
    }
    return most;
  }
  struct Plank {
    b2Body* body;
    b2Vec2 half;
  };
  std::unique_ptr<World2d> w;
  b2Body& ground;
  SoftBody<2>& block;
  DrawnFlat drawn{block};
  std::vector<Plank> planks;
};

class FlatJoints : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<UnderABlock> scene(float gravity = 9.81f) {
    if (GetParam() && !spes_) spes_.emplace();
    return std::make_unique<UnderABlock>(gravity, spes_ ? &*spes_ : nullptr);
  }

 private:
  std::optional<SpeRuntime> spes_;
};

/// A plate that hangs in the world, by each kind of joint.
TEST_P(FlatJoints, APlateThatHangsCarriesABlock) {
  const auto weld = [](UnderABlock& s, b2Body& plate) {
    s.join<b2WeldJointDef>(s.ground, plate, b2Vec2(-1.5f, 0));
  };
  const auto hang = [](UnderABlock& s, b2Body& plate) {
    for (const float x : {-1.4f, 1.4f})
      s.join<b2DistanceJointDef>(s.ground, plate, b2Vec2(1.2f * x, 5), b2Vec2(x, 0));
  };
  const auto rope = [](UnderABlock& s, b2Body& plate) {
    for (const float x : {-1.4f, 1.4f}) {
      b2DistanceJointDef rope_on;
      rope_on.Initialize(&s.ground, &plate, b2Vec2(1.2f * x, 5), b2Vec2(x, 0));
      rope_on.minLength = 0;
      rope_on.maxLength = rope_on.length;
      s.w->box2d.CreateJoint(&rope_on);
    }
  };
  const auto pin = [](UnderABlock& s, b2Body& plate) {
    for (const float x : {-1.4f, 1.4f}) s.join<b2RevoluteJointDef>(s.ground, plate, b2Vec2(x, 0));
  };
  const std::vector<std::function<void(UnderABlock&, b2Body&)>> kinds = {weld, hang, rope, pin};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const auto s = scene();
    b2Body& plate = s->add_plank({0, 0}, {1.5f, 0.1f}, 0.02f);
    kinds[kind](*s, plate);
    EXPECT_LT(s->deepest(60), 0.15f) << kind;
    s->w->run(1);
    EXPECT_NEAR(lowest(s->block), 0.1f, 0.1f * kFlatCell) << kind;
  }
}

TEST_P(FlatJoints, ABridgeOfPlanksCarriesABlock) {
  for (const float mass : {1.0f, 0.1f}) {
    const auto s = scene();
    constexpr int kPlanks = 8;
    b2Body* before = &s->ground;
    for (int i = 0; i < kPlanks; ++i) {
      const float middle = 0.65f * (static_cast<float>(i) - 0.5f * (kPlanks - 1));
      b2Body& plank = s->add_plank({middle, 0}, {0.3f, 0.08f}, mass);
      s->join<b2RevoluteJointDef>(*before, plank, b2Vec2(middle - 0.325f, 0));
      before = &plank;
    }
    s->join<b2RevoluteJointDef>(*before, s->ground, b2Vec2(0.65f * kPlanks / 2, 0));
    EXPECT_LT(s->deepest(60), 0.4f) << mass;
    s->w->run(1);
    EXPECT_LT(s->deepest(10), 0.1f) << mass;
  }
}

/// A lift moves as fast as its motor, if that is strong enough; with half of what both weigh they come down at half of g.
TEST_P(FlatJoints, ALiftIsAsStrongAsItsMotor) {
  for (const float strength : {3.0f, 0.5f}) {
    const auto s = scene();
    constexpr float kMass = 0.1f;
    b2Body& plate = s->add_plank({0, 0}, {1.5f, 0.1f}, kMass);
    b2PrismaticJointDef lift;
    lift.Initialize(&s->ground, &plate, {0, 0}, {0, 1});
    lift.enableMotor = true;
    lift.motorSpeed = 0.5f;
    lift.maxMotorForce = strength * (1 + kMass) * s->block.model().mass() * 9.81f;
    s->w->box2d.CreateJoint(&lift);
    EXPECT_LT(s->deepest(60), 0.2f) << strength;
    const auto later = [&] {
      s->w->run(0.5f);
      return plate.GetPosition().y;
    };
    const float first = plate.GetPosition().y, second = later(), third = later();
    if (strength > 1) {
      EXPECT_NEAR(third - first, 0.5f, 0.02f);
    } else {
      EXPECT_NEAR((third - second) - (second - first), -0.25f * 0.5f * 9.81f, 0.1f);
    }
  }
}

/// Wheels on springs, on a road.
/// Box2D applies a spring's force by itself: if softcell applied it as well, the spring would carry the block at two thirds of its way.
TEST_P(FlatJoints, ASpringActsAsStronglyUnderABlock) {
  const auto s = scene();
  b2Body& plank = s->add_plank({0, 1}, {1.2f, 0.1f}, 0.5f);
  s->join<b2PrismaticJointDef>(s->ground, plank, b2Vec2(0, 1), b2Vec2(0, 1));
  const float load = (plank.GetMass() + s->block.model().mass()) * 9.81f;
  b2DistanceJointDef spring;
  spring.Initialize(&s->ground, &plank, {0, -0.5f}, {0, 1});
  spring.minLength = 0.1f, spring.maxLength = 3;
  spring.stiffness = load / 0.2f;
  spring.damping = 2 * std::sqrt(spring.stiffness * plank.GetMass());
  auto* const joint = static_cast<b2DistanceJoint*>(s->w->box2d.CreateJoint(&spring));
  s->w->run(6);
  EXPECT_NEAR(plank.GetPosition().y, 1 - 0.2f, 0.01f * 0.2f);
  EXPECT_NEAR(joint->GetReactionForce(1 / kFlatStep).Length(), load, 0.01f * load);
}

TEST_P(FlatJoints, ACarCarriesABlock) {
  const auto s = scene();
  constexpr float kMass = 0.05f;
  s->w->add_box({0, -1.4f}, {20, 0.5f});
  b2Body& chassis = s->add_plank({0, 0}, {1.5f, 0.15f}, kMass);
  for (const float x : {-1.1f, 1.1f}) {
    b2BodyDef at;
    at.type = b2_dynamicBody;
    at.position = {x, -0.5f};
    b2Body* const wheel = s->w->box2d.CreateBody(&at);
    b2CircleShape round;
    round.m_radius = 0.4f;
    wheel->CreateFixture(&round, 0.3f * kMass * s->block.model().mass() / 0.5f)->SetFriction(0.9f);
    b2WheelJointDef spring;
    spring.Initialize(&chassis, wheel, at.position, {0, 1});
    spring.enableLimit = true;
    spring.lowerTranslation = -0.2f;
    spring.upperTranslation = 0.2f;
    b2LinearStiffness(spring.stiffness, spring.damping, 4, 0.7f, &chassis, wheel);
    s->w->box2d.CreateJoint(&spring);
  }
  EXPECT_LT(s->deepest(120), 0.15f);
  EXPECT_GT(chassis.GetPosition().y, -0.3f) << "its springs end there";
}

INSTANTIATE_TEST_SUITE_P(Solvers, FlatJoints, testing::Bool(),
                         [](const auto& solvers) { return solvers.param ? "Spes" : "Ppu"; });

/// Two bodies that move as their joint lets them: all its rows are at their targets.
class JointRows2d : public testing::Test {
 protected:
  b2Body* add_body(const b2Vec2& at) {
    b2BodyDef definition;
    definition.type = b2_dynamicBody;
    definition.position = at;
    definition.angle = 0.3f;
    b2Body* const body = world_.CreateBody(&definition);
    b2CircleShape disc;
    disc.m_radius = 0.2f;
    body->CreateFixture(&disc, 1);
    return body;
  }
  std::vector<JointRow> rows_of(b2JointDef& definition) {
    b2Joint* const joint = world_.CreateJoint(&definition);
    std::vector<JointRow> rows;
    add_joint_rows(*joint, 0, 1, kFlatStep, rows);
    return rows;
  }
  float speed(const JointRow& row) const {
    const auto of = [](const JointRow::Share& share, const b2Body& body) {
      const b2Vec2 v = body.GetLinearVelocity();
      return share.linear.dot(Vector3f(v.x, v.y, 0)) + share.angular.z() * body.GetAngularVelocity();
    };
    return of(row.of_a, *a_) + of(row.of_b, *b_);
  }
  b2World world_{{0, 0}};
  b2Body* a_ = add_body({0, 0});
  b2Body* b_ = add_body({2, 1});
};

TEST_F(JointRows2d, OfARevoluteJointKeepAnchorsTogether) {
  b2RevoluteJointDef pin;
  pin.Initialize(a_, b_, {1, 1});
  a_->SetLinearVelocity({3, 1}), a_->SetAngularVelocity(2), b_->SetAngularVelocity(-5);
  b_->SetLinearVelocity(a_->GetLinearVelocityFromWorldPoint({1, 1}) - b2Cross(-5, b2Vec2(-1, 0)));
  for (const JointRow& row : rows_of(pin)) EXPECT_NEAR(speed(row), 0, 1e-5f);
  pin.enableMotor = true;
  pin.motorSpeed = -7;
  pin.maxMotorTorque = 4;
  const auto rows = rows_of(pin);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(speed(rows[2]), rows[2].target, 1e-5f);
  EXPECT_FLOAT_EQ(rows[2].most, 4 * kFlatStep);
}

TEST_F(JointRows2d, OfAPrismaticJointLetItSlide) {
  b2PrismaticJointDef slide;
  const b2Vec2 axis(std::cos(0.3f), std::sin(0.3f));
  slide.Initialize(a_, b_, {1, 1}, axis);
  slide.enableLimit = true;
  slide.lowerTranslation = -0.5f;
  slide.upperTranslation = 2;
  const float spin = 1.5f, along = 4;
  for (b2Body* const body : {a_, b_}) body->SetAngularVelocity(spin);
  a_->SetLinearVelocity({1, 2});
  b_->SetLinearVelocity(a_->GetLinearVelocityFromWorldPoint(b_->GetWorldCenter()) + along * axis);
  const auto rows = rows_of(slide);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_NEAR(speed(rows[0]), 0, 1e-5f);
  EXPECT_NEAR(speed(rows[1]), 0, 1e-5f);
  // Where it is 0.5 m are left back and 2 m on.
  EXPECT_NEAR(speed(rows[2]), along, 1e-5f);
  EXPECT_NEAR(rows[2].target, -0.5f / kFlatStep, 1e-3f);
  EXPECT_NEAR(speed(rows[3]), -along, 1e-5f);
  EXPECT_NEAR(rows[3].target, -2 / kFlatStep, 1e-3f);
  EXPECT_EQ(rows[3].least, 0);
  EXPECT_EQ(rows[3].most, JointRow::kNoLimit);
}

TEST_F(JointRows2d, OfAPulleyKeepTheRopesLength) {
  b2PulleyJointDef pulley;
  pulley.Initialize(a_, b_, {0, 4}, {2, 4}, {0, 0}, {2, 1}, 2);
  a_->SetLinearVelocity({0, -3});
  b_->SetLinearVelocity({0, 1.5f});
  const auto rows = rows_of(pulley);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(speed(rows[0]), 0, 1e-5f);
  b_->SetLinearVelocity({0, 2.5f});
  EXPECT_NEAR(std::abs(speed(rows[0])), 2, 1e-5f);
}

/// A spring's row is how Box2D solves it: gamma and bias of its soft constraint.
TEST_F(JointRows2d, OfAWheelHaveItsSpring) {
  b2WheelJointDef wheel;
  wheel.Initialize(a_, b_, {2, 1}, {0, 1});
  wheel.stiffness = 40;
  wheel.damping = 3;
  b_->SetTransform(b_->GetPosition() + b2Vec2(0, 0.1f), b_->GetAngle());
  const auto rows = rows_of(wheel);
  ASSERT_EQ(rows.size(), 2u);
  const float gives_way = kFlatStep * (3 + kFlatStep * 40);
  EXPECT_FLOAT_EQ(rows[1].softness, 1 / gives_way);
  EXPECT_NEAR(rows[1].target, -0.1f * kFlatStep * 40 / gives_way, 1e-5f);
}

}  // namespace
}  // namespace softcell::ppu
