// What must be true of attachments in a Box2D world.

#include <gtest/gtest.h>

#include <box2d/b2_circle_shape.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "particles_where.h"
#include "soft_body_2d_scenes.h"
#include "softcell/soft_bodies/state_hash.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;

constexpr float kCellOf2d = 0.1f, kStepOf2d = 1.0f / 120;

SoftBodySettings firm() {
  SoftBodySettings settings;
  settings.cell_size = kCellOf2d;
  settings.half_width = 2;
  settings.density = 100;
  settings.alpha = 0.6f;
  settings.damping = 0.4f;
  return settings;
}

Vector2f middle_of(const SoftBody<2>& body) { return body.centre_of_mass(); }

float mass_of_body(const SoftBody<2>& body) {
  float sum = 0;
  for (const float mass : body.model().masses()) sum += mass;
  return sum;
}

Eigen::Vector2d momentum_of_all(const Box2dSoftBodies& bodies) {
  Eigen::Vector2d sum(0, 0);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (std::size_t i = 0; i < bodies[b].model().particles(); ++i) {
      sum += double{bodies[b].model().masses()[i]} * bodies[b].velocities()[i].cast<double>();
    }
  }
  return sum;
}

class Box2dAttachments : public testing::TestWithParam<ContactMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, Box2dAttachments,
                         testing::Values(ContactMethod::kSpheres, ContactMethod::kSurface), name_of_method);

/// Box2D does not move a disabled body: what hangs on it hangs as on a static one, and gives it no velocity.
TEST_P(Box2dAttachments, ADisabledBodyHoldsStill) {
  World2d w(9.81f, GetParam());
  b2BodyDef definition;
  definition.type = b2_dynamicBody;
  definition.position = {0, 2};
  definition.linearVelocity = {1, 0};
  b2Body* const box = w.box2d.CreateBody(&definition);
  b2PolygonShape shape;
  shape.SetAsBox(0.2f, 0.2f);
  box->CreateFixture(&shape, 10);
  box->SetEnabled(false);
  SoftBody<2>& body = w.soft.add(rectangle_model({6, 3}, firm()), {0, 1.65f});
  const AttachmentId weld = w.soft.attach(body, Patch<2>::of_surface({0, 1.8f}, 0.2f), *box);
  for (int i = 0; i < 240; ++i) w.soft.step(kStepOf2d);
  const auto ends = w.soft.attachment_ends(weld);
  ASSERT_TRUE(ends);
  EXPECT_LT((ends->patch - ends->other).norm(), 0.1f * kCellOf2d);
  EXPECT_EQ(box->GetLinearVelocity().y, 0);
  EXPECT_EQ(box->GetPosition().y, 2);
}

/// A hung body with another standing on it carries both, and no rope is longer than its length by more than 1 %.
TEST_P(Box2dAttachments, AHungBodyCarriesOneThatStandsOnIt) {
  World2d w(9.81f, GetParam());
  const SoftBody<2>& plank = w.soft.add(rectangle_model({12, 2}, firm()), {0, 1});
  const SoftBody<2>& load = w.soft.add(rectangle_model({4, 4}, firm()), {0, 1.35f});
  std::vector<AttachmentId> ropes;
  for (const float x : {-0.55f, 0.55f})
    ropes.push_back(w.soft.attach(plank, Patch<2>::of_surface({x, 1.2f}, 0.12f),
                                  {.kind = AttachmentKind::kRope, .point = Vector2f(x, 3)}));
  float longest = 0;
  for (int i = 0; i < 1200; ++i) {
    w.soft.step(kStepOf2d);
    for (const AttachmentId rope : ropes) {
      const auto ends = w.soft.attachment_ends(rope);
      ASSERT_TRUE(ends);
      longest = std::max(longest, (ends->patch - ends->other).norm() / ends->length);
    }
  }
  EXPECT_LT(longest, 1.01f);
  EXPECT_GT(middle_of(load).y(), middle_of(plank).y() + 0.2f);
  float carried = 0;
  constexpr int kSteps = 480;  // of some bounces
  for (int i = 0; i < kSteps; ++i) {
    w.soft.step(kStepOf2d);
    for (const AttachmentId rope : ropes) carried += w.soft.attachment(rope)->force.y() / kSteps;
  }
  EXPECT_NEAR(carried, 9.81f * (mass_of_body(plank) + mass_of_body(load)), 0.03f * carried);
}

TEST_P(Box2dAttachments, TwoFreeBodiesKeepTheirMomentum) {
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge, AttachmentKind::kRope}) {
    World2d w(0, GetParam());
    SoftBody<2>& a = w.soft.add(rectangle_model({4, 4}, firm()), {0, 0});
    SoftBody<2>& b = w.soft.add(rectangle_model({4, 4}, firm()), {0.6f, 0.05f});
    w.soft.attach(a, Patch<2>::of_surface({0.2f, 0.2f}, 0.17f), b, Patch<2>::of_surface({0.4f, 0.2f}, 0.17f),
                  {.kind = kind});
    a.add_velocity({1, 2});
    b.add_velocity({3, -1});
    b.add_angular_velocity(4);
    const Eigen::Vector2d before = momentum_of_all(w.soft);
    const double size = double{mass_of_body(a)} * std::sqrt(5.0) + double{mass_of_body(b)} * std::sqrt(10.0);
    w.run(500 * kStepOf2d);
    const Eigen::Vector2d after = momentum_of_all(w.soft);
    EXPECT_LT((after - before).norm(), 1e-5 * size);
    EXPECT_LT((middle_of(a) - middle_of(b)).norm(), 1.2f) << "they are attached";
    EXPECT_LT(a.deformation(), kCellOf2d);
  }
}

/// The angular momentum about the origin. @param size  is increased by the sum of its particles' magnitudes
double spin_of(const SoftBody<2>& body, double& size) {
  double spin = 0;
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    const Eigen::Vector2d x = body.position(i).cast<double>(), v = body.velocities()[i].cast<double>();
    const double mass = double{body.model().masses()[i]};
    spin += mass * (x.x() * v.y() - x.y() * v.x());
    size += mass * x.norm() * v.norm();
  }
  return spin;
}
double spin_of(const b2Body& body) {
  const b2Vec2 at = body.GetWorldCenter(), v = body.GetLinearVelocity();
  const float about_centre = (body.GetInertia() - body.GetMass() * body.GetLocalCenter().LengthSquared()) *
                             body.GetAngularVelocity();
  return double{body.GetMass()} * (double{at.x} * double{v.y} - double{at.y} * double{v.x}) +
         double{about_centre};
}

/// A compliant attachment is stretched: if its ends also move sideways, its two impulses do not lie on one line.
TEST_P(Box2dAttachments, TwoFreeBodiesThatAreApartKeepTheirAngularMomentum) {
  for (const float compliance : {1e-4f, 1e-3f, 1e-2f}) {
    World2d w(0, GetParam());
    SoftBody<2>& a = w.soft.add(rectangle_model({4, 4}, firm()), {-0.4f, -0.2f});
    SoftBody<2>& b = w.soft.add(rectangle_model({4, 4}, firm()), {0.4f, -0.2f});
    w.soft.attach(a, Patch<2>::of_surface({-0.2f, 0}, 0.3f), b, Patch<2>::of_surface({0.2f, 0}, 0.3f),
                  {.compliance = compliance});
    a.add_velocity({0.3f, 1});
    b.add_velocity({-0.3f, -1});
    b.add_angular_velocity(4);
    double size = 0, unused = 0;
    const double before = spin_of(a, size) + spin_of(b, size);
    w.run(1000 * kStepOf2d);
    EXPECT_LT(std::abs(spin_of(a, unused) + spin_of(b, unused) - before), 1e-5 * size) << compliance;
  }
}

/// What moves in an arc with a rigid body is pushed off its straight way.
TEST_P(Box2dAttachments, AFreeBodyAndARigidOneKeepTheirAngularMomentum) {
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge})
    for (const float compliance : {0.0f, 1e-3f}) {
      World2d w(0, GetParam());
      SoftBody<2>& soft = w.soft.add(rectangle_model({4, 4}, firm()), {-0.4f, -0.2f});
      b2Body* const box = w.add_box({0.4f, 0}, {0.2f, 0.2f}, 100);
      w.soft.attach(soft, Patch<2>::of_surface({-0.2f, 0}, 0.3f), *box,
                    {.kind = kind, .compliance = compliance});
      soft.add_velocity({0.3f, 1});
      box->SetLinearVelocity({-0.3f, -1});
      double size = 0, unused = 0;
      const double before = spin_of(soft, size) + spin_of(*box);
      w.run(1000 * kStepOf2d);
      EXPECT_LT(std::abs(spin_of(soft, unused) + spin_of(*box) - before), 5e-5 * size)
          << static_cast<int>(kind) << " that gives " << compliance;
    }
}

TEST_P(Box2dAttachments, AHingeToARigidBodyCarriesIt) {
  World2d w(9.81f, GetParam());
  const SoftBody<2>& top = w.soft.add(rectangle_model({6, 2}, firm()), {0, 2});
  w.soft.attach(top, Patch<2>::of_surface({0, 2.2f}, 0.15f));
  b2Body* const bar = w.add_box({0, 1.5f}, {0.05f, 0.45f}, 20);
  const AttachmentId hinge = w.soft.attach(top, Patch<2>::of_surface({0, 2.0f}, 0.12f), *bar,
                                           {.kind = AttachmentKind::kHinge, .point = Vector2f(0, 1.95f)});
  bar->ApplyLinearImpulseToCenter({0.5f * bar->GetMass(), 0}, true);
  float farthest = 0;
  for (int i = 0; i < 240; ++i) {
    w.soft.step(kStepOf2d);
    farthest = std::max(farthest, std::abs(bar->GetAngle()));
    ASSERT_LT(w.soft.attachment(hinge)->gap, 0.02f) << i;
  }
  EXPECT_GT(farthest, 0.1f) << "it swings";
  EXPECT_GT(bar->GetPosition().y, 1.4f) << "and does not fall";
}

TEST_P(Box2dAttachments, BreakWhenTheyWouldCarryMore) {
  for (const float share : {0.9f, 3.0f}) {  // it falls into the rope, and swings up and down in it
    World2d w(9.81f, GetParam());
    const SoftBody<2>& lamp = w.soft.add(rectangle_model({4, 4}, firm()), {0, 0});
    const float weight = 9.81f * mass_of_body(lamp);
    const AttachmentId id = w.soft.attach(lamp, Patch<2>::of_surface({0, 0.4f}, 0.12f),
                                          {.kind = AttachmentKind::kRope,
                                           .point = Vector2f(0, 1.5f),
                                           .compliance = 1e-4f,
                                           .break_force = 10 * weight});
    w.run(3);
    ASSERT_TRUE(w.soft.attachment(id)) << "it hangs still";
    w.soft.detach(id);
    w.soft[0].reset({0, 0});
    const AttachmentId weak = w.soft.attach(
        lamp, Patch<2>::of_surface({0, 0.4f}, 0.12f),
        {.kind = AttachmentKind::kRope, .point = Vector2f(0, 1.5f), .break_force = share * weight});
    w.run(1);
    EXPECT_EQ(w.soft.attachment(weak).has_value(), share > 1) << share;
    const auto ended = w.soft.poll_ended_attachments();
    EXPECT_EQ(ended.size(), share > 1 ? 0u : 1u);
    for (const EndedAttachment& one : ended) EXPECT_EQ(one.reason, EndedAttachment::Reason::kBroken);
  }
}

/// A hundred times the weight of the patch hangs from it: most of it is a rigid body that is welded to the soft one's lower end.
TEST_P(Box2dAttachments, AWeldCarriesAHundredTimesItsPatchWithoutCreep) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  World2d w(9.81f, GetParam());
  SoftBodySettings settings = firm();
  settings.alpha = 1;
  settings.damping = 0.3f;
  settings.half_width = 4;
  const SoftBody<2>& body = w.soft.add(rectangle_model({4, 4}, settings), {0, 2});
  const auto top = particles_where(body, [](const Vector2f& p) { return p.y() > 0.35f; });
  const auto bottom = particles_where(body, [](const Vector2f& p) { return p.y() < 0.05f; });
  float patch = 0;
  for (const std::uint32_t i : top) patch += body.model().masses()[i];
  const float load = 100 * patch - mass_of_body(body);
  ASSERT_GT(load, 100);
  b2Body* const weight = w.add_box({0, 1.75f}, {0.2f, 0.2f}, load / 0.16f);
  const AttachmentId weld = w.soft.attach(body, Patch<2>::of_particles(top));
  w.soft.attach(body, Patch<2>::of_particles(bottom), *weight);
  std::vector<Vector2f> before;
  for (const std::uint32_t i : top) before.push_back(body.position(i));
  float worst = 0;
  for (int second = 0; second < 600; ++second) {
    w.run(1);
    for (std::size_t i = 0; i < top.size(); ++i)
      worst = std::max(worst, (body.position(top[i]) - before[i]).norm());
  }
  EXPECT_LT(worst, 0.01f * kCellOf2d);
  const auto state = w.soft.attachment(weld);
  ASSERT_TRUE(state);
  const float carried = 9.81f * (load + mass_of_body(body));
  EXPECT_NEAR(state->force.y(), carried, 0.02f * carried);
  EXPECT_LT(weight->GetLinearVelocity().Length(), 0.05f);
}

/// By the momentum of the body, not by what the attachment says of itself.
/// @return  force on the body in each step, with the break force given; 0 after it broke
std::vector<float> forces_on(ContactMethod contacts, float break_force, bool suddenly, AttachmentKind kind,
                             int* broken_at = nullptr) {
  World2d w(0, contacts);
  SoftBody<2>& body = w.soft.add(rectangle_model({4, 4}, firm()), {0, 0});
  AttachmentSettings<2> settings{.kind = kind, .break_force = break_force};
  if (kind == AttachmentKind::kRope) settings.point = Vector2f(0, 1.2f);
  const auto upper = particles_where(body, [](const Vector2f& p) { return p.y() > 0.25f; });
  const AttachmentId id = w.soft.attach(body, Patch<2>::of_particles(upper), settings);
  std::vector<float> forces;
  if (suddenly) body.add_velocity({0, -3});
  for (int i = 0; i < 960; ++i) {
    const float gravity = suddenly ? 0.0f : 0.025f * static_cast<float>(i);
    w.box2d.SetGravity({0, -gravity});
    const Eigen::Vector2d before = momentum_of_all(w.soft);
    w.soft.step(kStepOf2d);
    const Eigen::Vector2d changed = momentum_of_all(w.soft) - before;
    forces.push_back(static_cast<float>(changed.y()) / kStepOf2d + gravity * mass_of_body(body));
    if (broken_at != nullptr && *broken_at < 0 && !w.soft.attachment(id)) *broken_at = i;
  }
  return forces;
}

TEST_P(Box2dAttachments, BreakAtTheirBreakForceLoadedSlowlyOrSuddenly) {
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge, AttachmentKind::kRope}) {
    for (const bool suddenly : {false, true}) {
      const std::vector<float> held = forces_on(GetParam(), 1e9f, suddenly, kind);
      const float most = *std::ranges::max_element(held);
      for (const float share : {0.3f, 0.6f, 0.9f}) {
        const float force = share * most;
        int broken_at = -1;
        const std::vector<float> broke = forces_on(GetParam(), force, suddenly, kind, &broken_at);
        ASSERT_GE(broken_at, 0) << share << " suddenly: " << suddenly;
        const auto at = static_cast<std::size_t>(broken_at);
        for (std::size_t i = 0; i < at; ++i) EXPECT_LE(broke[i], 1.05f * force);
        // It carries no more than its break force, and breaks when the one that holds carries that.
        EXPECT_NEAR(broke[at], force, 0.05f * force) << share << " suddenly: " << suddenly;
        EXPECT_GE(held[at], 0.95f * force) << share << " suddenly: " << suddenly;
        ASSERT_LT(at + 10, broke.size());
        for (std::size_t i = at + 1; i <= at + 10; ++i) EXPECT_NEAR(broke[i], 0, 0.01f * force);
      }
    }
  }
}

TEST_P(Box2dAttachments, FollowAPointThatTheProgramMoves) {
  World2d w(0, GetParam());
  const SoftBody<2>& body = w.soft.add(rectangle_model({4, 4}, firm()), {0, 0});
  const AttachmentId id = w.soft.attach(body, Patch<2>::of_surface({0, 0.2f}, 0.2f));
  const Vector2f from = middle_of(body);
  w.soft.move_attachment(id, from + Vector2f(1, 0.5f), 1.5707963f, 1);
  w.run(2);
  EXPECT_LT((middle_of(body) - from - Vector2f(1, 0.5f)).norm(), 0.02f);
  const Vector2f across = body.position(body.model().particles() - 1) - body.position(0);
  EXPECT_LT(std::abs(std::atan2(across.y(), across.x()) - std::atan2(1.0f, 1.0f) - 1.5707963f), 0.05f);
}

/// What presses on particles that are held meets what holds them, however light they are.
TEST(Box2dAttachmentsOfDrawnEdges, WhatIsWeldedAsAWholeCarriesARigidBody) {
  for (const float mass : {2.0f, 300.0f}) {
    World2d w(9.81f, ContactMethod::kSurface);
    const SoftBody<2>& table = w.soft.add(rectangle_model({6, 3}, firm()), {0, 1});
    const AttachmentId weld = w.soft.attach(
        table, Patch<2>::of_particles(particles_where(table, [](const Vector2f&) { return true; })));
    const b2Body* const load = w.add_box({0, 1.46f}, {0.1f, 0.1f}, mass / 0.04f);
    w.run(2);
    const float settled = load->GetPosition().y;
    EXPECT_NEAR(settled, 1.45f, 0.1f * kCellOf2d) << mass;  // the drawn edge is half a cell above the cells
    w.run(4);
    EXPECT_NEAR(load->GetPosition().y, settled, 0.01f * kCellOf2d) << mass;
    const auto state = w.soft.attachment(weld);
    ASSERT_TRUE(state);
    const float weight = 9.81f * (mass + mass_of_body(table));
    EXPECT_NEAR(state->force.y(), weight, 0.03f * weight) << mass;
  }
}

/// In Box2D a dynamic body without mass neither falls nor is moved. It has no fixture, or one of density 0.
double energy_of(const SoftBody<2>& body, const b2Body& box) {
  double sum = 0.5 * double{box.GetMass()} * double{box.GetLinearVelocity().LengthSquared()} +
               0.5 * double{box.GetInertia()} * std::pow(double{box.GetAngularVelocity()}, 2) +
               9.81 * double{box.GetMass()} * double{box.GetPosition().y};
  for (std::size_t i = 0; i < body.model().particles(); ++i)
    sum += double{body.model().masses()[i]} *
           (0.5 * double{body.velocities()[i].squaredNorm()} + 9.81 * double{body.position(i).y()});
  return sum;
}

/// A heavy box falls on a few cells on the ground, of which some particles are welded to the world. Contacts that felt what holds these and
/// contacts that did not undid each other's impulses, and more: in 274 of 1,000 such scenes energy came from nothing.
TEST(Box2dAttachmentsOfDrawnEdges, GiveNoEnergyToWhatIsPressedBetweenABoxAndTheGround) {
  std::mt19937 random(1);
  const auto number = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 1000) / 1000;
  };
  for (int scene = 0; scene < 60; ++scene) {
    SCOPED_TRACE(scene);
    World2d w(9.81f, ContactMethod::kSurface);
    w.add_box({0, -1}, {20, 1});
    SoftBodySettings settings = firm();
    settings.density = 50;
    settings.alpha = number(0.05f, 1);
    const int columns = 1 + static_cast<int>(random() % 4), rows = 1 + static_cast<int>(random() % 3);
    SoftBody<2>& body = w.soft.add(rectangle_model({columns, rows}, settings), {0, 0.051f});
    const auto part = random() % 4;  // all particles, the lower row, the left end, or any
    const auto held = particles_where(body, [&](const Vector2f& p) {
      return part == 0 || (part == 1 && p.y() < 0.06f) || (part == 2 && p.x() < 0.05f) ||
             (part == 3 && random() % 2 == 0);
    });
    if (held.empty()) continue;
    AttachmentSettings<2> weld;
    if (random() % 2 == 0) weld.break_force = number(50, 3000);
    w.soft.attach(body, Patch<2>::of_particles(held), weld);
    const b2Vec2 half{number(0.05f, 0.3f), number(0.05f, 0.3f)};
    const b2Body& box = *w.add_box({number(0, 0.1f) * static_cast<float>(columns), number(0.9f, 1.6f)}, half,
                                   number(100, 1500));
    const double before = energy_of(body, box);
    for (int step = 0; step < 240; ++step) {
      w.soft.step(kStepOf2d);
      ASSERT_LT(energy_of(body, box), 1.05 * before) << step;
    }
  }
}

TEST_P(Box2dAttachments, HoldToADynamicBodyWithoutMass) {
  for (const bool with_fixture : {false, true}) {
    for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge, AttachmentKind::kRope}) {
      World2d w(9.81f, GetParam());
      const SoftBody<2>& body = w.soft.add(rectangle_model({4, 4}, firm()), {0, 0});
      b2BodyDef definition;
      definition.type = b2_dynamicBody;
      definition.position = {0, 1};
      b2Body* const rigid = w.box2d.CreateBody(&definition);
      b2CircleShape circle;
      circle.m_radius = 0.1f;
      if (with_fixture) rigid->CreateFixture(&circle, 0);
      w.soft.attach(body, Patch<2>::of_surface({0, 0.4f}, 0.12f), *rigid, {.kind = kind});
      w.run(2);
      EXPECT_EQ(rigid->GetPosition(), b2Vec2(0, 1));
      EXPECT_NEAR(middle_of(body).y(), 0.2f, 0.1f);
    }
  }
}

/// Two that are welded overlap where they lie, and do not push each other apart; when they are free they do.
TEST_P(Box2dAttachments, WhatIsWeldedDoesNotTouchEachOther) {
  World2d w(0, GetParam());
  const SoftBody<2>& a = w.soft.add(rectangle_model({4, 4}, firm()), {0, 0});
  const SoftBody<2>& b = w.soft.add(rectangle_model({4, 4}, firm()), {0.45f, 0});
  const AttachmentId id = w.soft.attach(a, Patch<2>::of_surface({0.15f, 0.2f}, 0.2f), b,
                                        Patch<2>::of_surface({0.15f, 0.2f}, 0.2f));
  w.run(1);
  EXPECT_NEAR((middle_of(a) - middle_of(b)).norm(), 0.45f, 0.01f);
  w.soft.detach(id);
  w.run(1);
  EXPECT_GT((middle_of(a) - middle_of(b)).norm(), 0.48f);
}

TEST_P(Box2dAttachments, ThingsThatVanishTakeTheirAttachmentsWithThem) {
  World2d w(9.81f, GetParam());
  SoftBody<2>& a = w.soft.add(rectangle_model({4, 4}, firm()), {0, 1});
  SoftBody<2>& b = w.soft.add(rectangle_model({4, 4}, firm()), {0.6f, 1});
  b2Body* const bar = w.add_box({0, 3}, {0.1f, 0.1f}, 5);
  const auto patch = [](const SoftBody<2>& body) {
    return Patch<2>::of_surface(body.centre_of_mass(), 0.2f);
  };
  const AttachmentId to_bar = w.soft.attach(a, patch(a), *bar);
  const AttachmentId to_b = w.soft.attach(a, patch(a), b, patch(b));
  w.run(0.1f);
  w.box2d.DestroyBody(bar);
  w.soft.step(kStepOf2d);
  EXPECT_FALSE(w.soft.attachment(to_bar));
  w.soft.remove(b);
  EXPECT_FALSE(w.soft.attachment(to_b));
  const auto ended = w.soft.poll_ended_attachments();
  ASSERT_EQ(ended.size(), 2u);
  for (const EndedAttachment& one : ended) EXPECT_EQ(one.reason, EndedAttachment::Reason::kGone);
  w.run(0.1f);
}

TEST_P(Box2dAttachments, SayWhatIsOutOfRange) {
  World2d w(9.81f, GetParam()), other(9.81f, GetParam());
  SoftBody<2>& a = w.soft.add(rectangle_model({4, 4}, firm()), {0, 1});
  SoftBody<2>& stranger = other.soft.add(rectangle_model({4, 4}, firm()), {0, 1});
  b2Body* const elsewhere = other.add_box({0, 0}, {1, 1});
  const auto patch = Patch<2>::of_surface(a.centre_of_mass(), 0.2f);
  EXPECT_THROW(w.soft.attach(stranger, patch), std::invalid_argument);
  EXPECT_THROW(w.soft.attach(a, patch, a, patch), std::invalid_argument);
  EXPECT_THROW(w.soft.attach(a, patch, *elsewhere), std::invalid_argument);
  if (GetParam() == ContactMethod::kSpheres) {
    EXPECT_THROW(w.soft.attach(a, patch, *w.box2d.GetBodyList()), std::invalid_argument) << "a particle";
  }
  EXPECT_THROW(w.soft.attach(a, Patch<2>::of_surface({9, 9}, 0.2f)), std::invalid_argument);
  EXPECT_THROW(w.soft.attach(a, patch, {.kind = AttachmentKind::kRope}), std::invalid_argument);
  EXPECT_THROW(w.soft.detach(AttachmentId{7}), std::invalid_argument);
  const AttachmentId id = w.soft.attach(a, patch);
  EXPECT_THROW(w.soft.detach(AttachmentId{}), std::invalid_argument) << "a default one names none";
  EXPECT_FALSE(w.soft.attachment(AttachmentId{}));
  EXPECT_THROW(w.soft.move_attachment(id, {NAN, 0}), std::invalid_argument);
  EXPECT_THROW(w.soft.move_attachment(id, {0, 0}, 0, -1), std::invalid_argument);
}

/// Contacts and attachments are solved together: what lands on a welded patch does not move it in the step in which it lands, and what lands
/// on a hung body does not make its rope longer.
TEST(Box2dAttachmentsOfDrawnEdges, HoldInTheStepInWhichSomethingLands) {
  World2d w(9.81f, ContactMethod::kSurface);
  const SoftBody<2>& shelf = w.soft.add(rectangle_model({4, 2}, firm()), {0, 1});
  const SoftBody<2>& plank = w.soft.add(rectangle_model({4, 2}, firm()), {2, 1});
  const auto patch = Patch<2>::of_surface({0, 1.1f}, 0.3f);
  w.soft.attach(shelf, patch);
  const AttachmentId rope = w.soft.attach(plank, Patch<2>::of_surface({2, 1.1f}, 0.3f),
                                          {.kind = AttachmentKind::kRope, .point = Vector2f(2, 3)});
  w.run(1);
  for (const float x : {0.0f, 2.0f})
    w.soft.add(rectangle_model({4, 4}, firm()), {x, 1.4f}).add_velocity({0, -3});
  float fastest = 0, longest = 0;
  for (int i = 0; i < 120; ++i) {
    w.soft.step(kStepOf2d);
    for (const Vector2f& v : shelf.velocities()) fastest = std::max(fastest, v.norm());
    const auto ends = w.soft.attachment_ends(rope);
    longest = std::max(longest, (ends->patch - ends->other).norm() / ends->length);
  }
  EXPECT_LT(fastest, 0.001f) << "m/s";
  EXPECT_LT(longest, 1.001f);
}

/// A world without attachments has its own filter, and gets it back.
/// Things that hang from each other, which may sleep: a plank from the world, a box from it, and a second plank from the box.
struct Mobile {
  explicit Mobile(ContactMethod contacts) : world(9.81f, contacts) {
    world.soft.let_sleep(SleepSettings{});
    upper = &world.soft.add(rectangle_model({6, 3}, calm()), {0, 3});
    box = world.add_box({0, 2.5f}, {0.2f, 0.1f}, 200);
    lower = &world.soft.add(rectangle_model({3, 3}, calm()), {0, 1.7f});
    to_world = world.soft.attach(*upper, Patch<2>::of_surface({0, 3.3f}, 0.15f));
    to_box = world.soft.attach(*upper, Patch<2>::of_surface({0, 3}, 0.15f), *box, rope({0, 2.6f}));
    from_box = world.soft.attach(*lower, Patch<2>::of_surface({0, 2}, 0.15f), *box, rope({0, 2.4f}));
  }
  static AttachmentSettings<2> rope(const Vector2f& point) {
    return {.kind = AttachmentKind::kRope, .point = point, .length = 0.45f};
  }
  static SoftBodySettings calm() {
    SoftBodySettings settings = firm();
    settings.damping = 0.5f;
    return settings;
  }
  bool all_sleep() const { return upper->asleep() && !box->IsAwake() && lower->asleep(); }
  bool none_sleeps() const { return !upper->asleep() && box->IsAwake() && !lower->asleep(); }
  void settle() {
    box->SetLinearDamping(2);
    box->SetAngularDamping(2);
    world.run(20);
    ASSERT_TRUE(all_sleep());
  }

  World2d world;
  SoftBody<2>*upper, *lower;
  b2Body* box;
  AttachmentId to_world{}, to_box{}, from_box{};
};

TEST_P(Box2dAttachments, WhatIsAttachedSleepsTogetherAndStaysWhereItIs) {
  Mobile mobile(GetParam());
  bool together = true;
  for (int i = 0; i < 2400; ++i) {
    mobile.world.soft.step(kStepOf2d);
    together &= mobile.all_sleep() || mobile.none_sleeps();
  }
  EXPECT_TRUE(together);
  ASSERT_TRUE(mobile.all_sleep());
  const float force = mobile.world.soft.attachment(mobile.to_world)->force.norm();
  const float weight =
      9.81f * (mass_of_body(*mobile.upper) + mass_of_body(*mobile.lower) + mobile.box->GetMass());
  EXPECT_NEAR(force, weight, 0.1f * weight) << "it is told what the weld carried last";
  const std::uint64_t upper = state_hash(*mobile.upper), lower = state_hash(*mobile.lower);
  mobile.world.run(2);
  EXPECT_TRUE(mobile.all_sleep());
  EXPECT_EQ(state_hash(*mobile.upper), upper);
  EXPECT_EQ(state_hash(*mobile.lower), lower);
}

/// Whatever disturbs a part wakes all of it.
TEST_P(Box2dAttachments, WhatIsAttachedWakesTogether) {
  const struct {
    const char* name;
    void (*disturb)(Mobile& mobile);
  } kCases[] = {
      {"the upper end is moved",
       [](Mobile& m) {
         const Vector2f there = m.world.soft.attachment_ends(m.to_world)->other;
         m.world.soft.move_attachment(m.to_world, there + Vector2f(0.1f, 0), 0, 0.5f);
       }},
      {"the box is pushed",
       [](Mobile& m) {
         m.box->ApplyLinearImpulseToCenter({0.5f, 0}, true);
       }},
      {"the box is put elsewhere",
       [](Mobile& m) {
         m.box->SetTransform(m.box->GetPosition() + b2Vec2(0.02f, 0), 0);
         m.box->SetAwake(true);
       }},
      {"the lower plank is pushed",
       [](Mobile& m) {
         m.lower->add_velocity({0.5f, 0});
       }},
      {"the weld is let go", [](Mobile& m) { m.world.soft.detach(m.to_world); }},
      {"gravity turns",
       [](Mobile& m) {
         m.world.box2d.SetGravity({1, -9.81f});
       }},
      {"the lower plank is let go", [](Mobile& m) { m.world.soft.detach(m.from_box); }},
  };
  for (const auto& [name, disturb] : kCases) {
    SCOPED_TRACE(name);
    Mobile mobile(GetParam());
    ASSERT_NO_FATAL_FAILURE(mobile.settle());
    disturb(mobile);
    for (int i = 0; i < 3; ++i) mobile.world.soft.step(kStepOf2d);
    EXPECT_TRUE(mobile.none_sleeps());
  }
}

TEST_P(Box2dAttachments, WakeWhenTheRigidBodyTheyHangOnIsMovedOrVanishes) {
  enum class Move { kPlace, kVelocity, kGone };
  for (const Move move : {Move::kPlace, Move::kVelocity, Move::kGone}) {
    SCOPED_TRACE(static_cast<int>(move));
    World2d w(9.81f, GetParam());
    w.soft.let_sleep(SleepSettings{});
    b2Body* const beam = w.add_box({0, 2}, {0.5f, 0.1f});
    if (move == Move::kVelocity) beam->SetType(b2_kinematicBody);
    SoftBody<2>& body = w.soft.add(rectangle_model({6, 3}, Mobile::calm()), {0, 1.6f});
    w.soft.attach(body, Patch<2>::of_surface({0, 1.9f}, 0.2f), *beam);
    w.run(12);
    ASSERT_TRUE(body.asleep());
    const float before = middle_of(body).y();
    if (move == Move::kPlace) beam->SetTransform({0, 2.05f}, 0);
    if (move == Move::kVelocity) beam->SetLinearVelocity({0, 0.02f});  // slower than what counts as rest
    if (move == Move::kGone) w.box2d.DestroyBody(beam);
    w.run(2.5f);
    EXPECT_FALSE(move != Move::kPlace && body.asleep());
    if (move == Move::kGone) {
      EXPECT_LT(middle_of(body).y(), before - 5);
    } else {
      EXPECT_NEAR(middle_of(body).y(), before + 0.05f, 0.01f);
    }
  }
}

/// A place that the program moves slower than what counts as rest takes the body along.
TEST_P(Box2dAttachments, FollowAPlaceThatMovesSlowly) {
  World2d w(9.81f, GetParam());
  w.soft.let_sleep(SleepSettings{});
  SoftBody<2>& body = w.soft.add(rectangle_model({6, 3}, Mobile::calm()), {0, 1});
  const AttachmentId hand = w.soft.attach(body, Patch<2>::of_surface({0, 1.3f}, 0.2f));
  w.run(12);
  ASSERT_TRUE(body.asleep());
  const Vector2f before = middle_of(body);
  w.soft.move_attachment(hand, w.soft.attachment_ends(hand)->other + Vector2f(0.1f, 0), 0, 5);
  bool slept = false;
  for (int i = 0; i < 590; ++i) {
    w.soft.step(kStepOf2d);
    slept |= body.asleep();
  }
  EXPECT_FALSE(slept);
  EXPECT_NEAR(middle_of(body).x(), before.x() + 0.1f, 0.01f);
  w.run(10);
  EXPECT_TRUE(body.asleep());
}

TEST_P(Box2dAttachments, SleepOnWhenTheOriginMoves) {
  Mobile mobile(GetParam());
  ASSERT_NO_FATAL_FAILURE(mobile.settle());
  mobile.world.soft.shift_origin({-7, 3});
  mobile.world.run(0.5f);
  EXPECT_TRUE(mobile.all_sleep());
}

TEST(Box2dAttachmentsOfCircles, LeaveTheWorldsFilterAsItWas) {
  b2World world({0, 0});
  b2ContactFilter* const before = world.GetContactManager().m_contactFilter;
  {
    Box2dSoftBodies soft(world, ContactMethod::kSpheres);
    const SoftBody<2>& a = soft.add(rectangle_model({4, 4}, firm()), {0, 0});
    EXPECT_EQ(world.GetContactManager().m_contactFilter, before);
    soft.attach(a, Patch<2>::of_surface({0, 0.2f}, 0.2f));
  }
  EXPECT_EQ(world.GetContactManager().m_contactFilter, before);
}

}  // namespace
}  // namespace softcell::ppu
