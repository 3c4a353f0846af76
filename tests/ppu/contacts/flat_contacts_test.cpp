// Soft bodies in a Box2D world that touch with their drawn edges.
#include <gtest/gtest.h>

#include <box2d/b2_chain_shape.h>
#include <box2d/b2_circle_shape.h>
#include <box2d/b2_edge_shape.h>
#include <box2d/b2_motor_joint.h>
#include <box2d/b2_mouse_joint.h>
#include <box2d/b2_wheel_joint.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "../fracture/crack_depth.h"
#include "../soft_body_2d_scenes.h"
#include "drawn_flat.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/lattice/outline_distance.h"
#include "ppu/surfaces/flat_layer.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kStep2d = 1.0f / 120;

SoftBodySettings calm(float cell_size = 0.25f) {
  return {.cell_size = cell_size, .half_width = 2, .density = 5, .alpha = 0.5f, .damping = 0.3f};
}

std::vector<Vector2f> corners_of(const b2Body& box, const Vector2f& half) {
  std::vector<Vector2f> corners;
  for (const float x : {-half.x(), half.x()})
    for (const float y : {-half.y(), half.y()}) {
      const b2Vec2 corner = box.GetWorldPoint({x, y});
      corners.emplace_back(corner.x, corner.y);
    }
  return corners;
}

std::vector<Contact2d> contacts_in(const Box2dSoftBodies& bodies) {
  std::vector<Contact2d> contacts;
  bodies.append_contacts(contacts);
  return contacts;
}

double mass_of(const SoftBody<2>& body) { return double{body.model().mass()}; }

TEST(OutlineDistance, IsThatOfASquareWithAHole) {
  Skin2d skin;
  skin.rest = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {1, 3}, {3, 3}, {3, 1}};
  skin.outlines = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  const OutlineDistance outline(skin);
  EXPECT_FLOAT_EQ(outline.signed_distance({0.5f, 2}), -0.5f);
  EXPECT_FLOAT_EQ(outline.signed_distance({2, 2}), 1);  // in the hole
  EXPECT_FLOAT_EQ(outline.signed_distance({-3, -4}), 5);
  EXPECT_FLOAT_EQ(outline.signed_distance({7, 2}), 3);
  EXPECT_FLOAT_EQ(outline.signed_distance({2, 0.75f}), -0.25f);
  EXPECT_EQ(outline.signed_distance({4, 2}), 0);
}

/// Half a cell around its cells, all through the layer.
TEST(FlatLayer, IsALayerWithTheDrawnEdgeInMarginCells) {
  const auto model = rectangle_model({4, 3}, calm());
  const Skin2d skin = make_skin_2d(model->lattice(), 0.5f);
  const FlatLayer flat(*model, skin);
  const ContactModel contact(flat);
  const Lattice<3>& layer = contact.lattice();
  ASSERT_EQ(layer.cells.size(), 12u + 2 * 7 + 4);
  EXPECT_TRUE(contact.is_flat());
  EXPECT_NEAR(contact.mass(), model->mass(), 1e-6 * model->mass());
  std::vector<Vector3f> places;
  flat.lift(SoftBody<2>(model, {1, 2}).positions(), 0.125f, places);
  ASSERT_EQ(places.size(), layer.particles.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vector3f expected = layer.rest_position(i) + Vector3f(1, 2, 0);
    EXPECT_LT((places[i] - expected).norm(), 1e-5f) << i;
  }
  for (std::uint32_t c = 0; c < layer.cells.size(); ++c) {
    const Eigen::Vector2i cell = layer.cells[c].head<2>();
    EXPECT_EQ(contact.is_margin(c), (cell.array() < 0).any() || cell.x() > 3 || cell.y() > 2);
    const FieldValue field = contact.surface.field(c, {0.5f, 0.5f, 0.3f});
    EXPECT_EQ(field.gradient.z(), 0);
    if (cell.y() == 1 && cell.x() == 0) {
      EXPECT_NEAR(field.distance, -1, 0.05f);
    } else if (cell.y() == 1 && cell.x() == -1) {
      EXPECT_NEAR(field.distance, 0, 0.05f);
    }
    // A place of a margin cell is the same place beyond the cell beside.
    const Anchor there = anchor_in_cell(layer, c, {0.25f, 0.75f, 0.5f}), held = contact.held(there);
    EXPECT_FALSE(contact.is_margin(held.cell));
    EXPECT_LT((there.of(places) - held.of(places)).norm(), 1e-5f);
    for (const std::uint32_t particle : held.particle) EXPECT_LT(particle, 2 * model->particles());
  }
  for (const SurfacePointAtRest& point : contact.surface.points()) EXPECT_EQ(point.xi.z(), 0.5f);
}

/// The thread that steps the world, or SPEs.
class FlatContacts : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<World2d> world(float gravity = 9.81f) {
    if (!GetParam()) return std::make_unique<World2d>(gravity, ContactMethod::kSurface);
    return std::make_unique<World2d>(gravity, ContactMethod::kSurface, spes_.emplace());
  }

 private:
  std::optional<SpeRuntime> spes_;
};

/// Crushed cells are pushed back one way, and their body's shape pulls them the other way. Friction that felt only the latter made such a
/// tower, which leans, cross the floor at 19 mm/s, for good.
TEST_P(FlatContacts, ALeaningTowerOnCrushedCellsDoesNotCrawl) {
  const auto w = world();
  w->add_box({0, -1}, {20, 1});
  SoftBodySettings settings = calm(0.1f);
  settings.half_width = 2;
  settings.density = 100;
  settings.alpha = 0.5f;
  settings.damping = 0.4f;
  settings.friction = 0.6f;
  const auto model = rectangle_model({6, 3}, settings);
  const SoftBody<2>& lower = w->soft.add(model, {0, 0.02f});
  w->soft.add(model, {0, 0.44f});
  w->add_box({0, 0.96f}, {0.1f, 0.1f}, 25);
  w->run(25);
  const Vector2f before = lower.centre_of_mass();
  w->run(10);
  EXPECT_LT((lower.centre_of_mass() - before).norm(), 0.02f);
}

TEST_P(FlatContacts, WhatIsDrawnRestsOnTheFloor) {
  const auto w = world();
  w->add_box({0, -1}, {10, 1});
  SoftBody<2>& body = w->soft.add(rectangle_model({6, 4}, calm()), {0, 0.3f});
  w->run(8);
  EXPECT_LT(body.mean_speed(), 0.002f);
  EXPECT_LT(body.deformation(), 0.04f);  // its weight
  EXPECT_NEAR(lowest(body), 0, 0.05f);
  ASSERT_FALSE(contacts_in(w->soft).empty());
  float impulse = 0;
  for (const Contact2d& contact : contacts_in(w->soft)) {
    EXPECT_EQ(contact.first, &body);
    EXPECT_EQ(contact.second, nullptr);
    EXPECT_EQ(contact.rigid->GetType(), b2_staticBody);
    EXPECT_NEAR(contact.normal.y(), 1, 0.01f);
    EXPECT_NEAR(contact.position.y(), 0, 0.01f * 0.25f);  // not where matching would have moved the edge
    impulse += contact.impulse * contact.normal.y();
  }
  EXPECT_NEAR(impulse, mass_of(body) * 9.81 * double{kStep2d}, 0.02 * mass_of(body) * 9.81 * double{kStep2d});
  EXPECT_EQ(w->box2d.GetBodyCount(), 1);
}

/// In Box2D a dynamic body without mass neither falls nor is moved.
TEST_P(FlatContacts, ADynamicBodyWithoutMassHoldsWhatFallsOnIt) {
  const auto w = world();
  b2Body* const table = w->add_box({0, 0}, {1, 0.1f});
  table->GetFixtureList()->SetDensity(0);
  table->SetType(b2_dynamicBody);
  SoftBodySettings settings{.cell_size = 0.1f};
  const SoftBody<2>& body = w->soft.add(rectangle_model({4, 2}, settings), {0, 0.5f});
  w->run(3);
  EXPECT_EQ(table->GetPosition(), b2Vec2(0, 0));
  EXPECT_NEAR(body.bounds().low.y(), 0.1f + 0.5f * settings.cell_size, 0.02f);
}

TEST_P(FlatContacts, OneBodyRestsOnAnother) {
  const auto w = world();
  w->add_box({0, -1}, {10, 1});
  SoftBody<2>& below = w->soft.add(rectangle_model({8, 3}, calm()), {0, 0.15f});
  SoftBody<2>& above = w->soft.add(rectangle_model({4, 3}, calm()), {0.1f, 1.4f});
  w->run(8);
  EXPECT_LT(above.mean_speed(), 0.005f);
  EXPECT_NEAR(lowest(below), 0, 0.05f);
  // The lower one's upper edge is bent by the weight.
  const float gap = lowest(above) - highest(below);
  EXPECT_LT(gap, 0.02f * 0.25f);
  EXPECT_GT(gap, -0.2f * 0.25f);
}

/// The deepest particle of one body in what is drawn of another one, in cells.
float deepest_in_others(const std::vector<SoftBody<2>*>& bodies, const std::vector<DrawnFlat>& drawn) {
  float deepest = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Eigen::AlignedBox2f box;
    for (const Vector2f& p : bodies[i]->positions()) box.extend(p);
    std::vector<Vector2f> places;
    for (const SoftBody<2>* other : bodies)
      if (other != bodies[i])
        std::ranges::copy_if(other->positions(), std::back_inserter(places),
                             [&](const Vector2f& p) { return box.contains(p); });
    deepest = std::max(deepest, drawn[i].depth(places));
  }
  return deepest;
}

/// What is deep in another body leaves by the face by which it came in, however flat that one is pressed.
TEST_P(FlatContacts, StacksOfSoftBodiesDoNotMerge) {
  for (const Eigen::Vector2i& size : {Eigen::Vector2i(6, 4), Eigen::Vector2i(8, 2), Eigen::Vector2i(6, 1)}) {
    for (const float alpha : {0.15f, 0.3f}) {
      SCOPED_TRACE(testing::Message() << size.x() << " x " << size.y() << " cells, alpha " << alpha);
      const auto w = world();
      w->add_box({0, -1}, {20, 1});
      const SoftBodySettings settings{
          .cell_size = 0.25f, .half_width = 1, .density = 5, .alpha = alpha, .damping = 0.2f};
      std::vector<SoftBody<2>*> bodies;
      for (int i = 0; i < 5; ++i) {
        const float aside = i % 2 == 0 ? 0.1f : -0.1f;
        bodies.push_back(
            &w->soft.add(rectangle_model(size, settings), {aside, 0.3f + 1.3f * static_cast<float>(i)}));
        for (std::size_t p = 0; p < bodies.back()->positions().size(); ++p)
          bodies.back()->set_particle(p, bodies.back()->position(p), {0, -2});
      }
      std::vector<DrawnFlat> drawn;
      for (const SoftBody<2>* body : bodies) drawn.emplace_back(*body);
      w->run(4);
      for (int i = 0; i < 10; ++i) {
        w->run(0.1f);
        EXPECT_LT(deepest_in_others(bodies, drawn), 0.1f) << "after " << 4 + 0.1 * i << " seconds";
      }
    }
  }
}

TEST_P(FlatContacts, KeepMomentum) {
  const auto w = world(0);
  SoftBody<2>& body = w->soft.add(rectangle_model({4, 4}, calm()), {0, 0});
  SoftBody<2>& other = w->soft.add(rectangle_model({4, 3}, calm()), {2.5f, 0.3f});
  b2Body* const box = w->add_box({-3, 0.5f}, {0.4f, 0.4f}, 4);
  other.add_velocity({-3, 0});
  box->SetLinearVelocity({4, 0});
  const auto momentum = [&] {
    const b2Vec2 v = box->GetLinearVelocity();
    return Vector2d(body.linear_momentum().cast<double>() + other.linear_momentum().cast<double>() +
                    double{box->GetMass()} * Vector2d(double{v.x}, double{v.y}));
  };
  const Vector2d before = momentum();
  w->run(2);
  EXPECT_GT(other.linear_momentum().x(), -1.5 * mass_of(other)) << "they have not hit each other";
  EXPECT_LT(box->GetLinearVelocity().x, 3);
  EXPECT_LT((momentum() - before).norm(), 1e-4 * before.norm() + 1e-4);
}

/// A plate on two springs, as a car is, with a soft load in its middle: it lies level however fast all of it moves.
TEST_P(FlatContacts, ALoadStaysWhereItIsOnWhatMovesFast) {
  for (const float speed : {0.0f, 20.0f}) {
    const auto w = world();
    b2BodyDef definition;
    definition.type = b2_kinematicBody;
    definition.linearVelocity = {speed, 0};
    b2Body* const base = w->box2d.CreateBody(&definition);
    b2Body* const plate = w->add_box({0, 0.5f}, {1, 0.1f}, 10);
    plate->SetLinearVelocity({speed, 0});
    for (const float x : {-0.9f, 0.9f}) {
      b2WheelJointDef spring;
      spring.Initialize(base, plate, {x, 0.5f}, {0, 1});
      spring.stiffness = 2000;
      spring.damping = 100;
      w->box2d.CreateJoint(&spring);
    }
    SoftBody<2>& body = w->soft.add(rectangle_model({4, 4}, calm(0.1f)), {0, 0.82f});
    body.add_velocity({speed, 0});
    w->run(4);
    // The two springs bring a load's moment about the middle to rest at this angle.
    const double offset = double{plate->GetAngle()} * 2 * 2000 * 0.9 * 0.9 / (mass_of(body) * 9.81);
    EXPECT_NEAR(offset, 0, 0.005) << speed << " m/s";
  }
}

/// A disc without friction does not begin to turn.
TEST_P(FlatContacts, KeepAngularMomentum) {
  const auto w = world(0);
  SoftBodySettings settings = calm(0.1f);
  settings.friction = 0;
  SoftBody<2>& body = w->soft.add(rectangle_model({4, 4}, settings), {-0.8f, 0.15f});
  body.add_velocity({8, 0});
  b2BodyDef definition;
  definition.type = b2_dynamicBody;
  b2Body* const disc = w->box2d.CreateBody(&definition);
  b2CircleShape circle;
  circle.m_radius = 0.25f;
  disc->CreateFixture(&circle, 20)->SetFriction(0);
  const auto spin = [&] {
    double sum = double{disc->GetInertia()} * double{disc->GetAngularVelocity()};
    const auto add = [&](double mass, double x, double y, double vx, double vy) {
      sum += mass * (x * vy - y * vx);
    };
    for (std::size_t i = 0; i < body.positions().size(); ++i) {
      const Vector2d x = body.positions()[i].cast<double>(), v = body.velocities()[i].cast<double>();
      add(double{body.model().masses()[i]}, x.x(), x.y(), v.x(), v.y());
    }
    const b2Vec2 x = disc->GetWorldCenter(), v = disc->GetLinearVelocity();
    add(double{disc->GetMass()}, double{x.x}, double{x.y}, double{v.x}, double{v.y});
    return sum;
  };
  const double before = spin();
  w->run(0.5f);
  EXPECT_GT(disc->GetLinearVelocity().Length(), 0.3f) << "they have not met";
  EXPECT_NEAR(spin(), before, 0.005 * std::abs(before));
  EXPECT_LT(std::abs(disc->GetAngularVelocity()) * circle.m_radius,
            0.1f * disc->GetLinearVelocity().Length());
}

/// A needle stands up from the floor, narrower than the circles of a body are apart.
TEST_P(FlatContacts, AThinThingStaysOutside) {
  const auto w = world();
  b2Body* const floor = w->add_box({0, -1}, {10, 1});
  b2PolygonShape needle;
  const b2Vec2 corners[] = {{-0.02f, 1}, {0.02f, 1}, {0, 2}};
  needle.Set(corners, 3);
  floor->CreateFixture(&needle, 0);
  SoftBodySettings settings = calm();
  settings.alpha = 0.8f;
  SoftBody<2>& body = w->soft.add(rectangle_model({8, 3}, settings), {0.05f, 1.6f});
  const DrawnFlat drawn(body);
  float deepest = 0;
  for (int i = 0; i < 600; ++i) {
    w->soft.step(kStep2d);
    deepest = std::max(deepest, drawn.depth({{0, 1}}));
  }
  ASSERT_LT(body.centre_of_mass().y(), 1.6f) << "it has not come down to the needle";
  EXPECT_LT(deepest, 0.1f);
}

/// Edges and chains have no thickness, and the polygon a tenth of a cell. At 100 m/s a body of four cells is pressed flat in one step.
TEST_P(FlatContacts, NothingPassesAThinWall) {
  for (int kind = 0; kind < 4; ++kind) {
    const auto w = world(0);
    b2BodyDef definition;
    b2Body* const wall = w->box2d.CreateBody(&definition);
    b2EdgeShape edge;
    edge.SetTwoSided({2, kind == 3 ? 4.0f : -4.0f}, {2, kind == 3 ? -4.0f : 4.0f});
    b2ChainShape chain;
    const b2Vec2 corners[] = {{2, -4}, {2, -1}, {2, 1}, {2, 4}};
    chain.CreateChain(corners, 4, {2, -5}, {2, 5});
    b2PolygonShape thin;
    thin.SetAsBox(0.0125f, 4, {2, 0}, 0);
    wall->CreateFixture(kind == 1   ? static_cast<b2Shape*>(&chain)
                        : kind == 2 ? static_cast<b2Shape*>(&thin)
                                    : &edge,
                        0);
    for (const float speed : {5.0f, 20.0f, 50.0f, 100.0f}) {
      SoftBody<2>& body = w->soft.add(rectangle_model({4, 4}, calm()), {0, -0.5f});
      body.add_velocity({speed, 0});
      for (int i = 0; i < 120; ++i) {
        w->soft.step(kStep2d);
        for (const Vector2f& position : body.positions())
          ASSERT_LT(position.x(), 2 + 0.1f * 0.25f) << kind << " at " << speed << " m/s after " << i;
      }
      EXPECT_LT(body.linear_momentum().x(), 0) << "it has not come to the wall";
      w->soft.remove(body);
    }
  }
}

/// How high the middle of a block is that has fallen on a ground, in cells. Small cells and long steps press its edge deep into the ground.
float height_on(World2d& w, const b2Shape& ground, float cell, float alpha, float step) {
  b2BodyDef definition;
  b2Body* const body = w.box2d.CreateBody(&definition);
  body->CreateFixture(&ground, 0)->SetFriction(0.6f);
  SoftBodySettings settings = calm(cell);
  settings.alpha = alpha;
  settings.damping = 0.1f;
  SoftBody<2>& block = w.soft.add(rectangle_model({8, 6}, settings), {0, 10 * cell});
  for (float time = 0; time < 5; time += step) w.soft.step(step);
  const float height = block.centre_of_mass().y() / cell;
  w.soft.remove(block);
  w.box2d.DestroyBody(body);
  return height;
}

/// An edge is as long as a level, or one of many.
TEST_P(FlatContacts, AGroundOfEdgesCarriesAsABoxDoes) {
  b2PolygonShape box;
  box.SetAsBox(40, 1, {0, -1}, 0);
  b2EdgeShape edge;
  edge.SetTwoSided({-400, 0}, {400, 0});
  std::vector<b2Vec2> corners;
  for (int i = 80; i >= -80; --i) corners.push_back({0.5f * static_cast<float>(i), 0});
  b2ChainShape chain;
  chain.CreateChain(corners.data(), static_cast<int>(corners.size()), {41, 0}, {-41, 0});
  const auto w = world();
  for (const auto& [cell, alpha, step] : {std::tuple(0.05f, 0.7f, 1 / 60.0f),
                                          {0.1f, 0.7f, 1 / 60.0f},
                                          {0.1f, 0.3f, kStep2d},
                                          {0.25f, 1.0f, kStep2d}}) {
    const float expected = height_on(*w, box, cell, alpha, step);
    EXPECT_NEAR(height_on(*w, edge, cell, alpha, step), expected, 0.25f) << "an edge, cells of " << cell;
    EXPECT_NEAR(height_on(*w, chain, cell, alpha, step), expected, 0.25f) << "a chain, cells of " << cell;
  }
}

/// A body lay on both sides of such a plate, and stayed so, as the far side held what had been pressed through it.
TEST_P(FlatContacts, AChainAroundAThinPlateIsAFloor) {
  constexpr float kHalfWidth = 5;
  for (const bool turned : {false, true}) {
    for (const float thickness : {0.04f, 0.1f}) {
      for (const float alpha : {0.3f, 0.8f}) {
        for (const float speed : {5.0f, 17.0f}) {
          const auto w = world();
          std::array<b2Vec2, 4> corners{
              b2Vec2{-kHalfWidth, -thickness}, {kHalfWidth, -thickness}, {kHalfWidth, 0}, {-kHalfWidth, 0}};
          if (turned) std::reverse(corners.begin(), corners.end());
          b2ChainShape chain;
          chain.CreateLoop(corners.data(), static_cast<int>(corners.size()));
          b2BodyDef definition;
          w->box2d.CreateBody(&definition)->CreateFixture(&chain, 0)->SetFriction(0.6f);
          SoftBodySettings settings = calm();
          settings.alpha = alpha;
          settings.half_width = 1;
          SoftBody<2>& body = w->soft.add(rectangle_model({7, 5}, settings), {0, 1});
          body.add_velocity({0, -speed});
          w->run(6);
          EXPECT_NEAR(lowest(body), 0, 0.1f * settings.cell_size)
              << (turned ? "clockwise, " : "counterclockwise, ") << thickness << " m, alpha " << alpha << ", "
              << speed << " m/s";
        }
      }
    }
  }
}

/// Its middle comes below the edge long before its last part has left it.
TEST_P(FlatContacts, WhatHangsOverTheEndOfAnEdgeSlidesOff) {
  for (const bool is_chain : {false, true}) {
    for (const bool turned : {false, true}) {
      for (const float start : {0.1f, 0.3f, 0.6f}) {
        const auto w = world();
        b2BodyDef definition;
        b2Body* const ledge = w->box2d.CreateBody(&definition);
        std::array<b2Vec2, 4> corners{b2Vec2{-6, 0}, {-4, 0}, {-2, 0}, {0, 0}};
        if (turned) std::reverse(corners.begin(), corners.end());
        b2EdgeShape edge;
        edge.SetTwoSided(corners.front(), corners.back());
        b2ChainShape chain;
        const float beyond = turned ? 1.0f : -1.0f;
        chain.CreateChain(corners.data(), 4, corners.front() + b2Vec2(beyond, 0),
                          corners.back() - b2Vec2(beyond, 0));
        ledge->CreateFixture(is_chain ? static_cast<b2Shape*>(&chain) : &edge, 0)->SetFriction(0.4f);
        SoftBody<2>& bar = w->soft.add(rectangle_model({16, 2}, calm()), {start, 0.01f});
        const float size = bar.settings().cell_size;
        for (int i = 0; i < 300; ++i) {
          const std::vector<Vector2f> before(bar.positions().begin(), bar.positions().end());
          w->soft.step(kStep2d);
          for (std::size_t p = 0; p < before.size(); ++p)
            ASSERT_FALSE(before[p].x() < -0.5f * size && before[p].y() > 0 &&
                         bar.position(p).y() < -0.1f * size)
                << "particle " << p << " goes through the edge after " << i;
        }
        EXPECT_LT(bar.centre_of_mass().y(), -5) << is_chain << turned << " from " << start;
      }
    }
  }
}

/// The coefficient by which a body is slowed down that slides on a level ground.
double friction_of_slide(World2d& w, SoftBody<2>& body) {
  const float before = body.linear_momentum().x();
  body.add_velocity({3, 0});
  w.run(0.25f);
  const double slowed_by = 3 + (double{before} - double{body.linear_momentum().x()}) / mass_of(body);
  return slowed_by / (9.81 * 0.25);
}

/// Box2D takes the geometric mean of two coefficients.
TEST_P(FlatContacts, FrictionIsTheGeometricMeanOfBothCoefficients) {
  for (const auto& [of_body, of_floor] : {std::pair(0.3f, 1.0f), {0.6f, 0.5f}, {0.0f, 1.0f}}) {
    const auto w = world();
    w->add_box({0, -1}, {20, 1})->GetFixtureList()->SetFriction(of_floor);
    SoftBodySettings settings = calm();
    settings.friction = of_body;
    SoftBody<2>& body = w->soft.add(rectangle_model({6, 2}, settings), {-3, 0.13f});
    w->run(4);
    EXPECT_NEAR(friction_of_slide(*w, body), std::sqrt(double{of_body} * double{of_floor}), 0.02);
  }
}

/// Bodies of their own, fixtures of one body, and boxes of which every other one has sunk by a thousandth of a cell.
TEST_P(FlatContacts, BoxesSideBySideSlowDownWhatSlidesAsOneFloor) {
  for (const bool one_body : {false, true})
    for (const float lower : {0.0f, 0.00025f})
      for (const float friction : {0.0f, 0.3f, 0.8f}) {
        const auto w = world();
        b2BodyDef definition;
        b2Body* floor = w->box2d.CreateBody(&definition);
        for (int i = -20; i < 40; ++i) {
          b2PolygonShape box;
          box.SetAsBox(0.2f, 1, {0.4f * static_cast<float>(i), -1 - (i % 2 == 0 ? lower : 0)}, 0);
          if (!one_body) floor = w->box2d.CreateBody(&definition);
          floor->CreateFixture(&box, 0)->SetFriction(friction);
        }
        SoftBodySettings settings = calm();
        settings.friction = friction;
        SoftBody<2>& body = w->soft.add(rectangle_model({6, 2}, settings), {-3, 0.13f});
        w->run(4);
        EXPECT_NEAR(body.linear_momentum().x() / mass_of(body), 0, 1e-3) << "it does not lie still";
        EXPECT_NEAR(friction_of_slide(*w, body), double{friction}, 0.03)
            << (one_body ? "fixtures of one body" : "bodies") << ", steps of " << lower << " m";
      }
}

/// A soft body is pressed into the boxes by its weight in each substep, near the joint of two of them, too.
TEST_P(FlatContacts, BoxesSideBySideDoNotStopASoftBody) {
  for (const float alpha : {0.1f, 0.15f, 0.4f}) {
    const auto w = world();
    for (int i = -4; i < 40; ++i)
      w->add_box({0.37f * static_cast<float>(i), -0.5f}, {0.185f, 0.5f})->GetFixtureList()->SetFriction(0);
    SoftBodySettings settings = calm(0.1f);
    settings.alpha = alpha;
    settings.friction = 0;
    SoftBody<2>& body = w->soft.add(rectangle_model({5, 3}, settings), {0, 0.16f});
    body.add_velocity({2, 0});
    w->run(4);
    EXPECT_NEAR(body.linear_momentum().x() / mass_of(body), 2, 0.01) << "alpha " << alpha;
  }
}

/// Box2D takes the larger one of two restitutions.
TEST_P(FlatContacts, RestitutionIsTheLargerOfBoth) {
  for (const auto& [of_body, of_floor] : {std::pair(0.0f, 0.6f), {0.6f, 0.2f}}) {
    const auto w = world();
    w->add_box({0, -1}, {20, 1})->GetFixtureList()->SetRestitution(of_floor);
    SoftBodySettings settings = calm();
    settings.restitution = of_body;
    settings.alpha = 1;
    settings.damping = 1;
    SoftBody<2>& body = w->soft.add(rectangle_model({4, 4}, settings), {0, 2.125f});
    const DrawnFlat drawn(body);
    float top = 0;
    bool was_down = false;
    for (int i = 0; i < 240; ++i) {
      w->soft.step(kStep2d);
      was_down = was_down || body.linear_momentum().y() > 0;
      if (was_down) top = std::max(top, drawn.lowest());
    }
    EXPECT_NEAR(top, 0.36f * 2, 0.05f * 2);
  }
}

/// A floor and a trampoline far away, a sensor too, are fixtures of one body.
TEST_P(FlatContacts, RestitutionIsThatOfTheFixture) {
  float highest[2] = {};
  for (const bool with_others : {false, true}) {
    const auto w = world();
    b2Body* const ground = w->add_box({0, -1}, {20, 1});
    if (with_others)
      for (const bool sensor : {false, true}) {
        b2PolygonShape box;
        box.SetAsBox(1, 1, {sensor ? 0.0f : 50.0f, 0}, 0);
        b2Fixture* const fixture = ground->CreateFixture(&box, 0);
        fixture->SetRestitution(0.9f);
        fixture->SetSensor(sensor);
      }
    SoftBody<2>& body = w->soft.add(rectangle_model({4, 4}, calm()), {0, 2.125f});
    bool was_down = false;
    for (int i = 0; i < 240; ++i) {
      w->soft.step(kStep2d);
      was_down = was_down || body.linear_momentum().y() > 0;
      if (was_down) highest[with_others] = std::max(highest[with_others], body.centre_of_mass().y());
    }
  }
  EXPECT_EQ(highest[0], highest[1]);
}

/// A box of ten times its mass lies on a body, and goes no deeper.
TEST_P(FlatContacts, AHeavyBoxRestsOnABody) {
  const auto w = world();
  w->add_box({0, -1}, {10, 1});
  SoftBodySettings settings = calm();
  settings.alpha = 0.9f;
  SoftBody<2>& body = w->soft.add(rectangle_model({8, 4}, settings), {0, 0.13f});
  const auto density = static_cast<float>(10 * mass_of(body) / (1.2 * 0.4));
  b2Body* const box = w->add_box({0, 1.7f}, {0.6f, 0.2f}, density);
  w->run(25);
  const float then = box->GetPosition().y;
  w->run(20);
  EXPECT_NEAR(box->GetPosition().y, then, 0.01f * 0.25f);
  EXPECT_LT(std::abs(box->GetAngle()), 0.05f);
  EXPECT_GT(box->GetPosition().y, 0.6f);
}

/// Box2D adds the force later in its step, as it adds gravity.
TEST_P(FlatContacts, AForceOnABoxPressesAsItsWeightDoes) {
  const auto w = world();
  w->add_box({0, -1}, {10, 1});
  SoftBody<2>& body = w->soft.add(rectangle_model({8, 4}, calm()), {0, 0.13f});
  b2Body* const box = w->add_box({0, 1.6f}, {0.6f, 0.2f}, 5);
  const float force = 8 * box->GetMass() * 9.81f;
  float pressing = 0;
  for (int i = 0; i < 1200; ++i) {
    box->ApplyForceToCenter({0, -force}, true);
    w->soft.step(kStep2d);
    if (i < 1080) continue;
    for (const Contact2d& contact : contacts_in(w->soft))
      if (contact.rigid == box) pressing += contact.impulse * std::abs(contact.normal.y());
  }
  EXPECT_NEAR(pressing, force + box->GetMass() * 9.81f, 0.02f * force);  // in one second
  EXPECT_LT(DrawnFlat(body).depth(corners_of(*box, {0.6f, 0.2f})), 0.05f);
}

/// Joints press with the force that they have at most: each pulls with all of it, towards a place far below.
TEST_P(FlatContacts, JointsPressWithTheirForce) {
  for (const bool by_mouse : {true, false}) {
    const auto w = world();
    b2Body* const ground = w->add_box({0, -1}, {10, 1});
    SoftBody<2>& body = w->soft.add(rectangle_model({8, 4}, calm()), {0, 0.13f});
    b2Body* const box = w->add_box({0, 1.4f}, {0.6f, 0.2f}, 5);
    const float weight = box->GetMass() * 9.81f, force = 8 * weight;
    if (by_mouse) {
      b2MouseJointDef joint;
      joint.bodyA = ground, joint.bodyB = box;
      joint.target = box->GetPosition();
      joint.maxForce = force;
      joint.stiffness = 1000 * box->GetMass(), joint.damping = 20 * box->GetMass();
      static_cast<b2MouseJoint*>(w->box2d.CreateJoint(&joint))->SetTarget({0, -20});
    } else {
      b2MotorJointDef joint;
      joint.Initialize(ground, box);
      joint.linearOffset = {0, -20};
      joint.maxForce = force, joint.maxTorque = weight;
      w->box2d.CreateJoint(&joint);
    }
    float pressing = 0;
    for (int i = 0; i < 1200; ++i) {
      w->soft.step(kStep2d);
      if (i < 1080) continue;
      for (const Contact2d& contact : contacts_in(w->soft))
        if (contact.rigid == box) pressing += contact.impulse * std::abs(contact.normal.y());
    }
    EXPECT_NEAR(pressing, force + weight, 0.03f * force) << by_mouse;  // in one second
    EXPECT_NEAR(box->GetPosition().x, 0, 0.1f) << by_mouse;
    EXPECT_LT(DrawnFlat(body).depth(corners_of(*box, {0.6f, 0.2f})), 0.05f) << by_mouse;
  }
}

/// Doors of games: Box2D knows no velocity of them.
TEST_P(FlatContacts, WhatIsMovedByItsPlacePushesABodyAlong) {
  for (const b2BodyType type : {b2_staticBody, b2_kinematicBody})
    for (const float speed : {0.5f, 2.0f, 5.0f}) {
      const auto w = world();
      w->add_box({0, -1}, {30, 1});
      const SoftBody<2>& body = w->soft.add(rectangle_model({4, 4}, calm()), {0, 0.13f});
      const DrawnFlat drawn(body);
      b2Body* const door = w->add_box({-1.2f, 1.01f}, {0.2f, 1});
      door->SetType(type);
      for (int i = 1; i <= 90; ++i) {
        door->SetTransform({-1.2f + speed * kStep2d * static_cast<float>(i), 1.01f}, 0);
        w->soft.step(kStep2d);
        // Its first way is spread over four steps, as it may have moved for a frame of so many.
        if (i <= 5) continue;
        for (const Vector2f& at : drawn.edge())
          ASSERT_GT(at.x(), door->GetPosition().x + 0.2f - 0.1f * 0.25f) << speed << " m/s, step " << i;
      }
    }
}

/// A lift so slow that nobody on it moves fast enough to wake others.
TEST_P(FlatContacts, ASleepingStackFollowsASlowLift) {
  for (const float speed : {-0.08f, 0.08f}) {
    const auto w = world();
    w->soft.let_sleep(SleepSettings{.speed = 0.1f});
    b2Body* const lift = w->add_box({0, -1}, {10, 1});
    std::vector<const SoftBody<2>*> stack;
    for (int i = 0; i < 3; ++i)
      stack.push_back(
          &w->soft.add(rectangle_model({6, 2}, calm()), {0, 0.13f + 0.76f * static_cast<float>(i)}));
    w->run(6);
    ASSERT_TRUE(stack[2]->asleep());
    std::vector<float> before;
    for (const SoftBody<2>* const body : stack) before.push_back(body->centre_of_mass().y());
    for (int i = 1; i <= 480; ++i) {
      lift->SetTransform({0, -1 + speed * kStep2d * static_cast<float>(i)}, 0);
      w->soft.step(kStep2d);
    }
    w->run(1);
    for (std::size_t i = 0; i < stack.size(); ++i)
      EXPECT_NEAR(stack[i]->centre_of_mass().y() - before[i], 4 * speed, 0.1f * 0.25f)
          << speed << " m/s, body " << i;
  }
}

/// Where programs destroy bodies: after Box2D's step. What rests on the body then is not read any more.
TEST_P(FlatContacts, ABodyThatIsDestroyedWithinAStepKeepsNobodyAwake) {
  const auto w = world();
  w->add_box({0, -1}, {10, 1});
  w->soft.let_sleep(SleepSettings{});
  SoftBody<2>& body = w->soft.add(rectangle_model({6, 2}, calm()), {0, 0.13f});
  b2Body* box = w->add_box({0, 0.9f}, {0.2f, 0.2f}, 5);
  box->SetSleepingAllowed(false);
  w->run(4);
  ASSERT_FALSE(body.asleep()) << "the box on it never sleeps";
  w->soft.begin_step(kStep2d);
  w->box2d.Step(kStep2d, 8, 3);
  w->box2d.DestroyBody(box);
  w->soft.end_step(kStep2d);
  EXPECT_FALSE(body.asleep()) << "its load is gone";
  w->run(3);
  EXPECT_TRUE(body.asleep());
}

/// Nobody followed the wall while no soft body was there: it is where it is.
TEST_P(FlatContacts, AWallThatWasMovedBeforePushesNothing) {
  const auto w = world();
  w->add_box({0, -1}, {30, 1});
  w->soft.remove(w->soft.add(rectangle_model({2, 2}, calm()), {5, 0.13f}));
  b2Body* const wall = w->add_box({-1, 1}, {0.2f, 1});
  const SoftBody<2>* const first = &w->soft.add(rectangle_model({2, 2}, calm()), {5, 0.13f});
  w->soft.step(kStep2d);
  w->soft.remove(*first);
  for (int i = 0; i < 60; ++i) {
    wall->SetTransform({-1 - 0.01f * static_cast<float>(i), 1}, 0);
    w->soft.step(kStep2d);
  }
  const SoftBody<2>& body = w->soft.add(rectangle_model({2, 2}, calm()), {-1, 0.13f});
  w->run(1);
  EXPECT_NEAR(body.centre_of_mass().x(), -1, 0.05f);
}

TEST_P(FlatContacts, ATorqueOnABoxPressesItsCorners) {
  const auto w = world();
  w->add_box({0, -1}, {10, 1});
  SoftBody<2>& body = w->soft.add(rectangle_model({8, 4}, calm()), {0, 0.13f});
  b2Body* const box = w->add_box({0, 1.6f}, {0.6f, 0.2f}, 5);
  const float weight = box->GetMass() * 9.81f, torque = 0.25f * weight;  // half of what would turn it over
  float pressing = 0, moment = 0;
  for (int i = 0; i < 1200; ++i) {
    box->ApplyTorque(torque, true);
    w->soft.step(kStep2d);
    if (i < 1080) continue;
    for (const Contact2d& contact : contacts_in(w->soft)) {
      if (contact.rigid != box) continue;
      pressing += contact.impulse * std::abs(contact.normal.y());
      moment +=
          contact.impulse * (contact.position.x() - box->GetWorldCenter().x) * std::abs(contact.normal.y());
    }
  }
  EXPECT_NEAR(pressing, weight, 0.03f * weight);
  EXPECT_NEAR(std::abs(moment), torque, 0.1f * torque);
  EXPECT_LT(DrawnFlat(body).depth(corners_of(*box, {0.6f, 0.2f})), 0.05f);
}

/// Bodies so soft that their own weight crushes their lowest cells lay with velocities of up to 0.4 m/s that pushes took back, and crawled
/// over the ground by 3 cm/s.
TEST_P(FlatContacts, CrushedBodiesLieStillAndSleep) {
  for (const auto& [alpha, damping, cells] :
       {std::tuple(0.1f, 0.2f, 8), std::tuple(0.2f, 0.4f, 5), std::tuple(0.05f, 0.2f, 5)}) {
    const auto w = world();
    w->add_box({0, -1}, {10, 1});
    w->soft.let_sleep(SleepSettings{});
    SoftBody<2>& body =
        w->soft.add(rectangle_model({cells, cells},
                                    {.cell_size = 0.1f, .density = 30, .alpha = alpha, .damping = damping}),
                    {0, 0.06f});
    w->run(10);
    const float then = body.centre_of_mass().x();
    w->run(10);
    EXPECT_LT(std::abs(body.centre_of_mass().x() - then), 0.01f * 0.1f) << alpha;
    EXPECT_TRUE(body.asleep()) << alpha << ", " << body.mean_speed() << " m/s";
  }
}

/// Box2D knows where it was: it was seen three quarters of a cell deep, and stayed there for as long as pushes took to bring it out.
TEST_P(FlatContacts, WhatFliesIsMetWhereverItBegins) {
  constexpr float kCell = 0.1f, kRadius = 0.1f, kSpeed = 20;
  for (const bool from_rest : {false, true}) {
    for (int place = 0; place < 12; ++place) {
      const auto w = world(0);
      const SoftBody<2>& body = w->soft.add(rectangle_model({8, 8}, calm(kCell)), {0, 0});
      const DrawnFlat drawn(body);
      float left = 0;
      for (const Vector2f& at : drawn.edge()) left = std::min(left, at.x());
      const float gap = (from_rest ? 0.01f : 0.7f) + kSpeed * kStep2d * static_cast<float>(place) / 12;
      b2BodyDef definition;
      definition.type = b2_dynamicBody;
      definition.position = {left - gap - kRadius, 0.03f};
      b2Body* const disc = w->box2d.CreateBody(&definition);
      b2CircleShape circle;
      circle.m_radius = kRadius;
      disc->CreateFixture(&circle, 1);
      w->run(0.1f);
      disc->SetLinearVelocity({kSpeed, 0});
      float deepest = 0;
      for (int i = 0; i < 16; ++i) {
        w->run(kStep2d);
        const b2Vec2 at = disc->GetPosition();
        deepest = std::max(deepest, drawn.depth({{at.x + kRadius, at.y}}));
      }
      EXPECT_LT(deepest, 0.2f) << gap << " m before the body";
      EXPECT_LT(disc->GetLinearVelocity().x, kSpeed / 2) << "it has met nothing";
    }
  }
}

/// Two crates, one on the other, each of a hundredth, or a tenth, of its mass.
TEST_P(FlatContacts, LightCratesCarryABody) {
  for (const float mass : {0.01f, 0.1f}) {
    const auto w = world();
    w->add_box({0, -1}, {10, 1});
    SoftBody<2>& body = w->soft.add(rectangle_model({8, 6}, calm()), {-0.05f, 1.9f});
    const auto density = static_cast<float>(double{mass} * mass_of(body) / (1.6 * 0.6));
    std::array<b2Body*, 2> crates{};
    for (std::size_t i = 0; i < crates.size(); ++i)
      crates[i] = w->add_box({0, 0.3f + 0.6f * static_cast<float>(i)}, {0.8f, 0.3f}, density);
    const DrawnFlat drawn(body);
    float deepest = 0;
    for (int i = 0; i < 90; ++i) {
      w->run(1.0f / 60);
      std::vector<Vector2f> places;
      for (const b2Body* const crate : crates)
        for (const float x : {-0.8f, -0.4f, 0.0f, 0.4f, 0.8f}) {
          const b2Vec2 place = crate->GetWorldPoint({x, 0.3f});
          places.emplace_back(place.x, place.y);
        }
      deepest = std::max(deepest, drawn.depth(places));
    }
    EXPECT_LT(deepest, 0.35f) << mass;
    w->run(4);
    EXPECT_NEAR(lowest(body), 1.2f, 0.1f * 0.25f) << mass;
    EXPECT_NEAR(crates[0]->GetPosition().y, 0.3f, 0.1f * 0.25f) << mass;
  }
}

/// Its cells have stairs, what is drawn has none.
TEST_P(FlatContacts, ADiscRollsOnWhatIsDrawn) {
  constexpr float kGravity = 2;
  const auto w = world(kGravity);
  b2Body* const floor = w->add_box({0, -1}, {20, 1});
  floor->SetTransform({0, -1}, -0.2f);
  SoftBodySettings settings = calm(0.2f);
  settings.alpha = 1;
  std::vector<Eigen::Vector2i> cells;
  for (int x = -4; x < 4; ++x)
    for (int y = -4; y < 4; ++y)
      if (Vector2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f).norm() < 4)
        cells.push_back({x, y});
  const auto model = make_soft_body_model(lattice_from_cells(cells, settings.cell_size), settings);
  const Skin2d disc = make_skin_2d(model->lattice(), 0.5f, [](const Vector2f& at) { return at.norm() - 4; });
  // Down the slope from its middle, whose upper side is cos(0.2) above the floor's middle.
  const Vector2f normal(std::sin(0.2f), std::cos(0.2f)), along(normal.y(), -normal.x());
  const float radius = 4.5f * settings.cell_size;
  SoftBody<2>& body = w->soft.add(model, Vector2f(0, -1) + (1 + radius) * normal, &disc);
  const Vector2f begin = body.centre_of_mass();
  const float seconds = 4;
  w->run(seconds);
  const Vector2f way = body.centre_of_mass() - begin;
  EXPECT_NEAR(way.dot(normal), 0, 0.2f * settings.cell_size);  // its weight
  // Of a disc that rolls without sliding: two thirds of g sin(angle).
  EXPECT_NEAR(way.dot(along), kGravity * std::sin(0.2f) / 3 * seconds * seconds, 0.08f * way.dot(along));
}

/// A bar with a crack from above down to its middle is bent so that the crack closes.
TEST_P(FlatContacts, TheSidesOfACrackTouchEachOther) {
  const auto w = world(0);
  SoftBodySettings settings = calm(0.1f);
  settings.fracture = Fracture{.stretch = 1};
  SoftBody<2>& bar = w->soft.add(rectangle_model({12, 4}, settings), {0, -0.2f});
  EXPECT_TRUE(w->soft.cut(bar, Cut2d::stroke({0.001f, 0.05f}, {0, 1})).empty());
  ASSERT_TRUE(bar.model().is_piece());
  for (std::size_t i = 0; i < bar.positions().size(); ++i) {
    const Vector2f x = bar.position(i);
    bar.add_particle_velocity(i, {(x.x() > 0 ? -10 : 10) * std::max(0.0f, x.y()), 0});
  }
  float deepest = 0;
  for (int i = 0; i < 60; ++i) {
    w->soft.step(kStep2d);
    deepest = std::max(deepest, deepest_in_crack(bar));
  }
  EXPECT_GT(deepest, 0);
  EXPECT_LT(deepest, 0.35f);
  EXPECT_LT(deepest_in_crack(bar), 0.1f);
}

INSTANTIATE_TEST_SUITE_P(Workers, FlatContacts, testing::Bool(),
                         [](const auto& worker) { return worker.param ? "Spes" : "Ppu"; });

TEST(FlatContacts, CrushedCellsAreCounted) {
  struct Squashed {
    float height;  ///< of that at rest
    std::size_t crushed, inside_out;
  };
  for (const ContactMethod method : {ContactMethod::kSurface, ContactMethod::kSpheres}) {
    World2d world(0, method);
    SoftBody<2>& body = world.soft.add(rectangle_model({4, 3}, calm(0.1f)), {0, 5});
    world.soft.add(rectangle_model({2, 2}, calm(0.1f)), {5, 5});
    const std::vector<Vector2f> still(body.positions().size(), Vector2f::Zero());
    for (const Squashed& wanted :
         {Squashed{1, 0, 0}, Squashed{0.6f, 0, 0}, Squashed{0.4f, 12, 0}, Squashed{-0.8f, 12, 12}}) {
      std::vector<Vector2f> squashed;
      for (std::size_t i = 0; i < still.size(); ++i)
        squashed.push_back(body.model().lattice().rest_position(i).cwiseProduct(Vector2f(1, wanted.height)));
      body.set_state(squashed, still);
      const CrushedCellCount found = world.soft.crushed_cells();
      const bool counts = method == ContactMethod::kSurface;
      EXPECT_EQ(found.crushed, counts ? wanted.crushed : 0) << wanted.height;
      EXPECT_EQ(found.inside_out, counts ? wanted.inside_out : 0) << wanted.height;
    }
  }
}

TEST(FlatContacts, TheSameBitsForAnyNumberOfSpesAndSchedule) {
  const auto fall = [](SpeRuntime& spes) {
    World2d w(9.81f, ContactMethod::kSurface, spes);
    w.add_box({0, -1}, {10, 1});
    w.add_box({0.3f, 0.5f}, {0.3f, 0.3f}, 2);
    for (int i = 0; i < 4; ++i)
      w.soft.add(rectangle_model({5, 3}, calm()),
                 {0.2f * static_cast<float>(i), 1.6f + 1.2f * static_cast<float>(i)});
    w.run(2);
    std::uint64_t hash = 0;
    for (std::size_t b = 0; b < w.soft.size(); ++b) hash = state_hash(w.soft[b], hash);
    return hash;
  };
  SpeRuntime one({.spes = 1}), six({.spes = 6}), lazy({.spes = 3, .schedule = dma::parse_schedule("lazy")});
  const std::uint64_t expected = fall(one);
  EXPECT_EQ(fall(six), expected);
  EXPECT_EQ(fall(lazy), expected);
}

/// A block asleep on the floor, one that hangs on a rope from a place in the world, and one that the program pushes with a wall.
/// @param shift  of the world's origin in each step, metres   @return  where they are then, in the coordinates of the beginning
std::array<Vector2f, 3> where_they_are(ContactMethod method, const Vector2f& shift) {
  World2d w(9.81f, method);
  w.add_box({0, -1}, {50, 1});
  b2Body* const wall = w.add_box({6, 1}, {0.1f, 1});
  SoftBody<2>& asleep = w.soft.add(rectangle_model({4, 4}, calm()), {0, 0.2f});
  SoftBody<2>& hangs = w.soft.add(rectangle_model({3, 3}, calm()), {-4, 3});
  SoftBody<2>& pushed = w.soft.add(rectangle_model({3, 3}, calm()), {6.4f, 0.2f});
  const Vector2f top = Vector2f(-4, 3) + Vector2f(0.375f, 0.75f);
  AttachmentSettings<2> rope;
  rope.kind = AttachmentKind::kRope;
  rope.point = top + Vector2f(0, 0.5f);
  rope.length = 0.5f;
  w.soft.attach(hangs, Patch<2>::of_surface(top, 0.3f), rope);
  w.soft.let_sleep(SleepSettings{});
  w.run(10);
  EXPECT_TRUE(asleep.asleep());
  Vector2f origin(0, 0);
  for (int i = 0; i < 120; ++i) {
    w.soft.shift_origin(shift);
    origin += shift;
    wall->SetTransform(wall->GetPosition() + b2Vec2(0.5f * kStep2d, 0), 0);
    w.soft.step(kStep2d);
    EXPECT_TRUE(asleep.asleep());
  }
  return {asleep.centre_of_mass() + origin, hangs.centre_of_mass() + origin,
          pushed.centre_of_mass() + origin};
}

/// Until then all static bodies seemed to be moved, and carried along what lay on them.
TEST(ShiftOrigin, MovesEverythingAndPushesNothing) {
  for (const ContactMethod method : {ContactMethod::kSurface, ContactMethod::kSpheres})
    for (const Vector2f& shift : {Vector2f(0.01f, 0), Vector2f(0.7f, -0.3f), Vector2f(-20, 5)}) {
      const auto expected = where_they_are(method, {0, 0}), shifted = where_they_are(method, shift);
      EXPECT_GT(expected[2].x(), 6.8f) << "the wall pushes nothing";
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT((shifted[i] - expected[i]).norm(), 0.01f)
            << i << " shifted by " << shift.transpose()
            << (method == ContactMethod::kSpheres ? ", circles" : ", surfaces");
    }
  World2d w(9.81f, ContactMethod::kSurface);
  EXPECT_THROW(w.soft.shift_origin({0, std::numeric_limits<float>::infinity()}), std::invalid_argument);
}

}  // namespace
}  // namespace softcell::ppu
