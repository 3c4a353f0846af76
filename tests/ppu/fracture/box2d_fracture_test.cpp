// Bodies that break in a Box2D world.
#include <gtest/gtest.h>

#include <box2d/b2_chain_shape.h>
#include <box2d/b2_circle_shape.h>
#include <box2d/b2_edge_shape.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "../soft_body_2d_scenes.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_runtime.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

constexpr float kStep2d = 1.0f / 120;

SoftBodySettings brittle_2d(float stretch, std::optional<float> turn = {}) {
  SoftBodySettings settings{
      .cell_size = 0.1f, .half_width = 2, .density = 100, .alpha = 0.5f, .damping = 0.1f};
  settings.fracture = Fracture{.stretch = stretch, .turn = turn};
  return settings;
}

/// A disc of cells about the origin.
std::shared_ptr<const SoftBodyModel<2>> disc_model(int radius, const SoftBodySettings& settings) {
  std::vector<Eigen::Vector2i> cells;
  for (int x = -radius; x < radius; ++x)
    for (int y = -radius; y < radius; ++y)
      if (Vector2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f).norm() <
          static_cast<float>(radius))
        cells.push_back({x, y});
  return make_soft_body_model(lattice_from_cells(cells, settings.cell_size), settings);
}

std::uint64_t hash_of_all(const Box2dSoftBodies& bodies) {
  std::uint64_t hash = bodies.size();
  for (std::size_t b = 0; b < bodies.size(); ++b) hash = state_hash(bodies[b], hash);
  return hash;
}

struct Sums2d {
  double mass = 0, angular_momentum = 0;
  Vector2d momentum{0, 0};
};
Sums2d sums_of(const Box2dSoftBodies& bodies) {
  Sums2d sums;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (std::size_t i = 0; i < bodies[b].positions().size(); ++i) {
      const double m = double{bodies[b].model().masses()[i]};
      const Vector2d x = bodies[b].position(i).cast<double>(), v = bodies[b].velocities()[i].cast<double>();
      sums.mass += m;
      sums.momentum += m * v;
      sums.angular_momentum += m * (x.x() * v.y() - x.y() * v.x());
    }
  return sums;
}

void expect_finite(const Box2dSoftBodies& bodies) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const Vector2f& x : bodies[b].positions()) ASSERT_TRUE(x.allFinite());
}

class Box2dFracture : public testing::TestWithParam<ContactMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, Box2dFracture,
                         testing::Values(ContactMethod::kSpheres, ContactMethod::kSurface), name_of_method);

/// A bar of 12 cells along x with a weak middle that a weld at each end pulls apart.
TEST_P(Box2dFracture, ABarUnderTensionBreaksWhereItIsWeakAtTheStretchStated) {
  constexpr float kStretch = 0.1f, kWeak = 0.5f, kCell = 0.1f;
  World2d w(0, GetParam());
  SoftBodySettings settings = brittle_2d(kStretch);
  settings.half_width = 1;
  std::vector<Eigen::Vector2i> cells;
  for (int x = 0; x < 12; ++x)
    for (int y = 0; y < 2; ++y) cells.push_back({x, y});
  const auto model = make_soft_body_model(
      lattice_from_cells(cells, kCell, {-0.6f, 0}), settings, 0.5f,
      [](const Vector2f& at) { return std::abs(at.x() - 0.15f) < 0.06f ? kWeak : 1.0f; });
  SoftBody<2>& bar = w.soft.add(model, {0, 0});
  std::vector<std::uint32_t> left, right;
  for (std::uint32_t i = 0; i < model->particles(); ++i) {
    if (model->lattice().particles[i].x() <= 1) left.push_back(i);
    if (model->lattice().particles[i].x() >= 11) right.push_back(i);
  }
  const AttachmentId wall = w.soft.attach(bar, Patch<2>::of_particles(left));
  const AttachmentId hand = w.soft.attach(bar, Patch<2>::of_particles(right));
  w.soft.move_attachment(hand, {0.55f + 0.3f, 0.1f}, 0, 15);
  const auto elongation =
      [&](int x) {  // the mean of the links between the cells whose low corners are at x and x + 1
        double sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < bar.model().lattice().particles.size(); ++i) {
          const int at = bar.model().lattice().particles[i].x();
          sum += (at == x ? -0.5 : at == x + 2 ? 0.5 : 0) * double{bar.position(i).x()};
          count += at == x ? 1 : 0;
        }
        return sum / count / double{kCell} - 1;
      };
  double before = 0;
  for (int i = 0; i < 15 * 120 && w.soft.size() == 1; ++i) {
    before = elongation(7);
    w.soft.step(kStep2d);
  }
  ASSERT_EQ(w.soft.size(), 2u);
  EXPECT_NEAR(before, double{kStretch * kWeak}, 0.05 * double{kStretch * kWeak});
  const auto count = [&](std::size_t b) { return w.soft[b].model().lattice().cells.size() / 2; };
  EXPECT_TRUE((count(0) == 7 && count(1) == 5) || (count(0) == 8 && count(1) == 4))
      << count(0) << " and " << count(1);
  EXPECT_TRUE(w.soft.attachment(wall) && w.soft.attachment(hand));
  EXPECT_TRUE(w.soft.poll_ended_attachments().empty());
  const auto broken = w.soft.poll_broken();
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].body, &w.soft[0]);
  ASSERT_EQ(broken[0].pieces.size(), 1u);
  EXPECT_EQ(broken[0].pieces[0], &w.soft[1]);
  ASSERT_EQ(broken[0].particles_before.size(), 2u);
  for (std::size_t p = 0; p < 2; ++p) {
    const SoftBody<2>& piece = w.soft[p];
    ASSERT_EQ(broken[0].particles_before[p].size(), piece.positions().size());
    for (std::size_t i = 0; i < piece.positions().size(); ++i)
      EXPECT_EQ(piece.model().lattice().particles[i],
                model->lattice().particles[broken[0].particles_before[p][i]]);
  }
  EXPECT_GE(broken[0].faces, 2u);
  EXPECT_TRUE(w.soft.poll_broken().empty());
  w.run(5);
  EXPECT_EQ(w.soft.size(), 2u);
  float gap = 0;
  for (std::size_t b = 0; b < 2; ++b)
    gap = std::max(gap, w.soft[b].bounds().low.x() - w.soft[1 - b].bounds().high.x());
  EXPECT_GT(gap, 0.02f);
}

TEST_P(Box2dFracture, ABentBarBreaksByItsTurn) {
  for (const float turn : {0.1f, 3.0f}) {
    World2d w(9.81f, GetParam());
    SoftBodySettings settings{
        .cell_size = 0.1f, .half_width = 1, .density = 100, .alpha = 0.2f, .damping = 0.2f};
    settings.fracture = Fracture{.turn = turn};
    SoftBody<2>& bar = w.soft.add(rectangle_model({16, 1}, settings), {0, 2});
    w.soft.attach(bar, Patch<2>::of_surface({-0.75f, 2.05f}, 0.1f));
    w.run(2);
    if (turn < 1)
      EXPECT_GT(w.soft.size(), 1u);
    else
      EXPECT_EQ(w.soft.size(), 1u);
  }
}

TEST_P(Box2dFracture, ADiscThatFallsBreaksAndItsPiecesLieOnTheFloor) {
  World2d w(9.81f, GetParam());
  w.add_box({0, -0.5f}, {20, 0.5f});
  const SoftBody<2>& disc = w.soft.add(disc_model(6, brittle_2d(0.03f)), {0, 3});
  const double mass = double{disc.model().mass()};
  w.run(4);
  EXPECT_GT(w.soft.size(), 3u);
  expect_finite(w.soft);
  EXPECT_NEAR(sums_of(w.soft).mass, mass, 1e-5 * mass);
  for (std::size_t b = 0; b < w.soft.size(); ++b) {
    EXPECT_GT(w.soft[b].bounds().low.y(), GetParam() == ContactMethod::kSpheres ? 0 : -0.002f) << b;
    EXPECT_LT(w.soft[b].bounds().low.y(), 1) << b;
  }
  // Each particle of Box2D stands for one of a body.
  std::size_t particles = 0, outer = 0;
  for (const b2Body* body = w.box2d.GetBodyList(); body != nullptr; body = body->GetNext()) {
    const auto particle = w.soft.particle_of(*body);
    if (particle.body == nullptr) continue;
    ++particles;
    EXPECT_EQ(Vector2f(body->GetPosition().x, body->GetPosition().y),
              particle.body->position(particle.number));
    EXPECT_NEAR(body->GetMass(), particle.body->model().masses()[particle.number], 1e-6f);
    const auto& circle = static_cast<const b2CircleShape&>(*body->GetFixtureList()->GetShape());
    EXPECT_EQ(circle.m_radius, particle.body->model().contact_radius(particle.number));
  }
  for (std::size_t b = 0; b < w.soft.size(); ++b) outer += w.soft[b].model().outer().size();
  EXPECT_EQ(particles, GetParam() == ContactMethod::kSpheres ? outer : 0);
}

/// Edges and chains have two sides: a piece whose cells are pressed through one as it breaks off stays on the side of the whole.
TEST(Box2dFractureOfDrawnEdges, PiecesStayOnTheirSideOfAnEdge) {
  for (const bool chain : {false, true}) {
    for (const float speed : {2.0f, 4.0f, 8.0f}) {
      for (const float angle : {0.0f, 0.8f, 1.57f}) {
        SCOPED_TRACE(testing::Message()
                     << (chain ? "chain " : "edge ") << speed << " m/s, turned by " << angle);
        World2d w(9.81f, ContactMethod::kSurface);
        b2BodyDef ground;
        if (chain) {
          b2ChainShape shape;
          const b2Vec2 corners[] = {{40, 0}, {0, 0}, {-40, 0}};
          shape.CreateChain(corners, 3, {41, 0}, {-41, 0});
          w.box2d.CreateBody(&ground)->CreateFixture(&shape, 0);
        } else {
          b2EdgeShape shape;
          shape.SetTwoSided({-40, 0}, {40, 0});
          w.box2d.CreateBody(&ground)->CreateFixture(&shape, 0);
        }
        SoftBodySettings settings = brittle_2d(0.05f, 0.15f);
        settings.density = 300, settings.alpha = 0.6f;
        SoftBody<2>& bar = w.soft.add(rectangle_model({12, 4}, settings), {0, 0});
        bar.move_without_force(Eigen::Rotation2Df(angle), {0, 1});
        bar.add_velocity({0, -speed});
        w.run(2);
        EXPECT_GT(w.soft.size(), 1u);
        for (std::size_t b = 0; b < w.soft.size(); ++b) EXPECT_GT(w.soft[b].centre_of_mass().y(), 0) << b;
      }
    }
  }
}

/// A cut alone moves nothing: the upper half stays on the lower one, although their circles cover each other at first.
TEST(Box2dFractureOfCircles, PiecesAreNotPushedApartAndCarryEachOther) {
  World2d w;
  w.add_box({0, -0.5f}, {20, 0.5f});
  SoftBodySettings firm{.cell_size = 0.1f, .half_width = 2, .density = 100, .alpha = 0.9f, .damping = 0.3f};
  firm.friction = 0.8f;
  SoftBody<2>& block = w.soft.add(rectangle_model({10, 8}, firm), {0, 0.06f});
  w.run(2);
  const auto pieces = w.soft.cut(block, Cut2d::line(block.centre_of_mass() + Vector2f(0, 0.001f), {0, 1}));
  ASSERT_EQ(pieces.size(), 1u);
  SoftBody<2>& upper = block.centre_of_mass().y() > pieces[0]->centre_of_mass().y() ? block : *pieces[0];
  SoftBody<2>& lower = &upper == &block ? *pieces[0] : block;
  const Vector2f upper_before = upper.centre_of_mass(), lower_before = lower.centre_of_mass();
  float highest = 0, farthest = 0;
  for (int i = 0; i < 600; ++i) {
    w.soft.step(kStep2d);
    highest = std::max(highest, upper.centre_of_mass().y() - upper_before.y());
    farthest = std::max(farthest, std::abs(upper.centre_of_mass().x() - upper_before.x()));
  }
  EXPECT_LT(highest, 0.01f);
  EXPECT_LT(farthest, 0.05f);
  EXPECT_GT(upper.centre_of_mass().y(), upper_before.y() - 0.07f);
  EXPECT_LT((lower.centre_of_mass() - lower_before).norm(), 0.05f);
}

/// What flies apart and meets again touches.
TEST(Box2dFractureOfCircles, PiecesThatHaveBeenApartTouch) {
  World2d w(0);
  SoftBodySettings settings{
      .cell_size = 0.1f, .half_width = 2, .density = 100, .alpha = 0.9f, .damping = 0.2f};
  SoftBody<2>& block = w.soft.add(rectangle_model({8, 4}, settings), {0, 0});
  const auto pieces = w.soft.cut(block, Cut2d::line({0.001f, 0}, {1, 0}));
  ASSERT_EQ(pieces.size(), 1u);
  SoftBody<2>& right = block.centre_of_mass().x() > 0 ? block : *pieces[0];
  SoftBody<2>& left = &right == &block ? *pieces[0] : block;
  right.add_velocity({1, 0});
  left.add_velocity({-1, 0});
  w.run(0.5f);
  right.add_velocity({-2, 0});
  left.add_velocity({2, 0});
  float nearest = 1;
  for (int i = 0; i < 240; ++i) {
    w.soft.step(kStep2d);
    nearest = std::min(nearest, right.bounds().low.x() - left.bounds().high.x());
  }
  EXPECT_GT(nearest, 0.02f);
  EXPECT_LT(nearest, 0.06f);
}

/// Pieces fly apart as the whole turned.
TEST_P(Box2dFracture, KeepsBothMomentaForAThousandSteps) {
  World2d w(0, GetParam());
  SoftBody<2>& disc = w.soft.add(disc_model(6, brittle_2d(0.02f)), {0, 0});
  disc.add_angular_velocity(9);
  disc.add_velocity({0.3f, 0.1f});
  const Sums2d before = sums_of(w.soft);
  for (int i = 0; i < 1000; ++i) {
    const Sums2d earlier = sums_of(w.soft);
    const std::size_t bodies = w.soft.size();
    w.soft.step(kStep2d);
    if (bodies == w.soft.size()) continue;
    const Sums2d now = sums_of(w.soft);
    EXPECT_NEAR(now.mass, earlier.mass, 1e-6 * earlier.mass);
  }
  EXPECT_GT(w.soft.size(), 3u);
  const Sums2d after = sums_of(w.soft);
  EXPECT_NEAR(after.mass, before.mass, 1e-6 * before.mass);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-5 * before.mass * 5);
  // Pieces are some 25 m away by then, where a float is 2e-6 m.
  EXPECT_NEAR(after.angular_momentum, before.angular_momentum, 1e-5 * before.mass * 5 * 25);
}

TEST_P(Box2dFracture, HasTheSameBitsForAnyNumberOfSpesAndScheduleAndOnThePpu) {
  const auto fall = [](SolverFactory* spes) {
    b2World world(b2Vec2(0, -9.81f));
    std::optional<Box2dSoftBodies> made;
    if (spes != nullptr)
      made.emplace(world, *spes, GetParam());
    else
      made.emplace(world, GetParam());
    Box2dSoftBodies& bodies = *made;
    b2BodyDef floor;
    floor.position = {0, -0.5f};
    b2PolygonShape shape;
    shape.SetAsBox(20, 0.5f);
    world.CreateBody(&floor)->CreateFixture(&shape, 0);
    const auto model = disc_model(6, brittle_2d(0.05f, 0.5f));
    bodies.add(model, {0, 1.5f});
    bodies.add(model, {0.3f, 2.8f});
    for (int i = 0; i < 120; ++i) {
      bodies.step(kStep2d);
      if (i == 90) bodies.cut(bodies[1], Cut2d::line(bodies[1].centre_of_mass(), {1, 2}));
      if (i % 3 == 0) bodies.begin_ahead(kStep2d);
    }
    EXPECT_GT(bodies.size(), 4u);
    return hash_of_all(bodies);
  };
  SpeRuntime one({.spes = 1}), lazy({.spes = 6, .schedule = dma::parse_schedule("lazy")});
  const std::uint64_t expected = fall(&one);
  for (int spes = kSlowBuild ? 6 : 2; spes <= 6; ++spes) {
    SpeRuntime some({.spes = spes});
    EXPECT_EQ(fall(&some), expected) << spes;
  }
  EXPECT_EQ(fall(&lazy), expected);
  const std::uint64_t on_ppu = fall(nullptr);
  EXPECT_EQ(fall(nullptr), on_ppu);
}

/// The thread that makes pieces has all the time in the world, or none: no result depends on it.
TEST_P(Box2dFracture, ABodyStaysWholeUntilItsPiecesAreDue) {
  const auto tear = [](std::chrono::milliseconds pause) {
    World2d w(0, GetParam());
    SoftBody<2>& disc = w.soft.add(disc_model(7, brittle_2d(0.03f)), {0, 0});
    EXPECT_GT(disc.positions().size(), 100u);
    for (std::size_t i = 0; i < disc.positions().size(); ++i)
      disc.add_particle_velocity(i, Vector2f(disc.position(i).x() > 0.1f ? 3.0f : -3.0f, 0));
    int breaking = 0;
    for (int i = 0; i < 60 && w.soft.size() == 1; ++i) {
      w.soft.step(kStep2d);
      breaking += w.soft.is_breaking(disc) ? 1 : 0;
      std::this_thread::sleep_for(pause);
    }
    EXPECT_GT(w.soft.size(), 1u);
    EXPECT_GE(breaking, 2);
    w.run(0.2f);
    return hash_of_all(w.soft);
  };
  EXPECT_EQ(tear(std::chrono::milliseconds(0)), tear(std::chrono::milliseconds(30)));
}

TEST_P(Box2dFracture, ACutThatBeginsHasItsPiecesLaterAndTheSame) {
  const Cut2d half = Cut2d::line({0.01f, 0}, {1, 0});
  const SoftBodySettings jelly{.cell_size = 0.1f, .half_width = 1};
  World2d w(0, GetParam()), other(0, GetParam());
  SoftBody<2>& disc = w.soft.add(disc_model(6, jelly), {0, 0});
  EXPECT_FALSE(w.soft.begin_cut(disc, Cut2d::line({2, 0}, {1, 0})));
  EXPECT_TRUE(w.soft.begin_cut(disc, half));
  EXPECT_TRUE(w.soft.is_breaking(disc));
  EXPECT_TRUE(w.soft.poll_broken().empty());
  w.run(3.1f / 120);
  EXPECT_FALSE(w.soft.is_breaking(disc));
  const auto broken = w.soft.poll_broken();
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].body, &disc);
  ASSERT_EQ(broken[0].pieces.size(), 1u);
  ASSERT_EQ(other.soft.cut(other.soft.add(disc_model(6, jelly), {0, 0}), half).size(), 1u);
  for (std::size_t b = 0; b < 2; ++b)
    EXPECT_EQ(w.soft[b].positions().size(), other.soft[b].positions().size());
}

/// A body that is about to break is assigned, cut or removed.
TEST_P(Box2dFracture, WhatHappensToABodyThatIsBreakingIsKept) {
  const auto with_breaking_disc = [](const auto& work) {
    World2d w(0, GetParam());
    SoftBody<2>& disc = w.soft.add(disc_model(7, brittle_2d(0.03f)), {0, 0});
    const SoftBody<2> saved = disc;
    for (std::size_t i = 0; i < disc.positions().size(); ++i)
      disc.add_particle_velocity(i, Vector2f(disc.position(i).x() > 0.1f ? 3.0f : -3.0f, 0));
    for (int i = 0; i < 60 && !w.soft.is_breaking(disc); ++i) w.soft.step(kStep2d);
    ASSERT_TRUE(w.soft.is_breaking(disc));
    work(w, disc, saved);
    w.run(0.1f);
    expect_finite(w.soft);
  };
  with_breaking_disc([](World2d& w, SoftBody<2>& disc, const SoftBody<2>& saved) {
    disc = saved;
    w.run(0.1f);
    EXPECT_EQ(w.soft.size(), 1u);
    EXPECT_TRUE(w.soft.poll_broken().empty());
  });
  with_breaking_disc([](World2d& w, SoftBody<2>& disc, const SoftBody<2>&) {
    EXPECT_FALSE(w.soft.cut(disc, Cut2d::line(disc.centre_of_mass(), {0, 1})).empty());
    EXPECT_GT(w.soft.size(), 2u);
    EXPECT_EQ(w.soft.poll_broken().size(), 2u);
  });
  with_breaking_disc([](World2d& w, SoftBody<2>& disc, const SoftBody<2>&) {
    w.soft.remove(disc);
    w.run(0.1f);
    EXPECT_EQ(w.soft.size(), 0u);
    EXPECT_TRUE(w.soft.poll_broken().empty());
  });
  // The world goes while a break is under way.
  World2d w(0, GetParam());
  SoftBody<2>& disc = w.soft.add(disc_model(7, brittle_2d(0.03f)), {0, 0});
  EXPECT_TRUE(w.soft.begin_cut(disc, Cut2d::line({0, 0}, {1, 0})));
}

TEST_P(Box2dFracture, AttachmentsGoOnWithThePieceThatHasTheirPatch) {
  World2d w(9.81f, GetParam());
  SoftBody<2>& bar = w.soft.add(rectangle_model({10, 1}, {.cell_size = 0.1f, .half_width = 1}), {0, 2});
  const AttachmentId left = w.soft.attach(bar, Patch<2>::of_surface({-0.45f, 2.05f}, 0.08f));
  const AttachmentId middle = w.soft.attach(bar, Patch<2>::of_surface({0.1f, 2.05f}, 0.12f));
  const AttachmentId right = w.soft.attach(bar, Patch<2>::of_surface({0.45f, 2.05f}, 0.08f));
  const auto pieces = w.soft.cut(bar, Cut2d::line({0.101f, 2}, {1, 0}));
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(w.soft.attachment(left));
  EXPECT_FALSE(w.soft.attachment(middle));
  EXPECT_TRUE(w.soft.attachment(right));
  const auto ended = w.soft.poll_ended_attachments();
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].id, middle);
  EXPECT_EQ(ended[0].reason, EndedAttachment::Reason::kBroken);
  w.run(2);
  EXPECT_NEAR(w.soft.attachment_ends(right)->patch.y(), 2.05f, 0.01f);
  EXPECT_NEAR(w.soft.attachment_ends(left)->patch.y(), 2.05f, 0.01f);
  w.soft.remove(*pieces[0]);
  EXPECT_FALSE(w.soft.attachment(right) && w.soft.attachment(left));
  w.run(0.1f);
}

/// Both ways, at once and by the thread that makes pieces: a bar of 10 layers loses 3 of them.
TEST_P(Box2dFracture, PiecesOfFewerCellsThanStatedVanish) {
  for (const int across : {1, 10}) {
    SCOPED_TRACE(across);
    World2d w(9.81f, GetParam());
    const auto layer = static_cast<std::uint32_t>(across);
    SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1, .density = 100};
    settings.fracture = Fracture{.least_cells = 3 * layer + 1};
    SoftBody<2>& bar = w.soft.add(rectangle_model({10, across}, settings), {0, 2});
    SoftBody<2>& other = w.soft.add(rectangle_model({10, 1}, settings), {0, 4});
    EXPECT_EQ(bar.positions().size() > 100, across > 1);
    const float mass = bar.model().mass();
    // The particles of some layers.
    const auto patch_at = [&](int first, int last) {
      std::vector<std::uint32_t> particles;
      for (std::uint32_t i = 0; i < bar.model().particles(); ++i)
        if (const int x = bar.model().lattice().particles[i].x(); first <= x && x <= last)
          particles.push_back(i);
      return Patch<2>::of_particles(particles);
    };
    AttachmentSettings<2> rope;
    rope.kind = AttachmentKind::kRope;
    const AttachmentId stays = w.soft.attach(bar, patch_at(0, 1));
    const AttachmentId torn = w.soft.attach(bar, patch_at(6, 8));
    const AttachmentId gone = w.soft.attach(bar, patch_at(8, 10));
    const AttachmentId gone_by_b =
        w.soft.attach(other, Patch<2>::of_surface({0.45f, 4.05f}, 0.1f), bar, patch_at(9, 10), rope);
    const AttachmentId of_other = w.soft.attach(other, Patch<2>::of_surface({-0.45f, 4.05f}, 0.1f));
    const Cut2d end = Cut2d::line({0.201f, 0}, {1, 0});
    if (across == 1) {
      EXPECT_TRUE(w.soft.cut(bar, end).empty());
    } else {
      EXPECT_TRUE(w.soft.begin_cut(bar, end));
      EXPECT_TRUE(w.soft.is_breaking(bar));
      w.run(4.1f / 120);
      EXPECT_FALSE(w.soft.is_breaking(bar));
    }
    EXPECT_EQ(w.soft.size(), 2u);
    EXPECT_EQ(bar.model().lattice().cells.size(), 7 * layer);
    EXPECT_NEAR(bar.model().mass(), 0.7f * mass, 1e-5f * mass);
    const auto broken = w.soft.poll_broken();
    ASSERT_EQ(broken.size(), 1u);
    EXPECT_EQ(broken[0].body, &bar);
    EXPECT_TRUE(broken[0].pieces.empty());
    EXPECT_EQ(broken[0].vanished, 1u);
    ASSERT_EQ(broken[0].particles_before.size(), 1u);
    EXPECT_EQ(broken[0].particles_before[0].size(), bar.positions().size());
    EXPECT_TRUE(w.soft.attachment(stays) && w.soft.attachment(of_other));
    std::map<std::uint32_t, EndedAttachment::Reason> ended;
    for (const EndedAttachment& one : w.soft.poll_ended_attachments())
      ended[static_cast<std::uint32_t>(one.id)] = one.reason;
    const std::map<std::uint32_t, EndedAttachment::Reason> expected{
        {static_cast<std::uint32_t>(torn), EndedAttachment::Reason::kBroken},
        {static_cast<std::uint32_t>(gone), EndedAttachment::Reason::kGone},
        {static_cast<std::uint32_t>(gone_by_b), EndedAttachment::Reason::kGone}};
    EXPECT_EQ(ended, expected);
    w.run(0.5f);
    expect_finite(w.soft);
    EXPECT_TRUE(w.soft.attachment(stays));
    // Particles of what has vanished are in Box2D no longer.
    std::size_t particles = 0;
    for (const b2Body* body = w.box2d.GetBodyList(); body != nullptr; body = body->GetNext())
      particles += w.soft.particle_of(*body).body != nullptr ? 1 : 0;
    EXPECT_EQ(particles, GetParam() == ContactMethod::kSpheres
                             ? bar.model().outer().size() + other.model().outer().size()
                             : 0);
    w.soft.remove(bar);
    w.soft.remove(other);
    w.run(0.1f);
  }
}

TEST_P(Box2dFracture, ADiscThatFallsKeepsItsLargestPiecesOnly) {
  constexpr std::uint32_t kLeast = 6;
  World2d w(9.81f, GetParam());
  w.add_box({0, -0.5f}, {20, 0.5f});
  SoftBodySettings settings = brittle_2d(0.03f);
  settings.fracture->least_cells = kLeast;
  const SoftBody<2>& disc = w.soft.add(disc_model(6, settings), {0, 3});
  const double whole = double{disc.model().mass()};
  std::size_t vanished = 0;
  for (int i = 0; i < 240; ++i) {
    w.soft.step(kStep2d);
    for (const BrokenSoftBody2d& broken : w.soft.poll_broken()) {
      vanished += broken.vanished;
      EXPECT_EQ(broken.particles_before.size(), broken.pieces.size() + 1);
    }
  }
  EXPECT_GT(vanished, 0u);
  expect_finite(w.soft);
  EXPECT_EQ(&w.soft[0], &disc);
  EXPECT_LT(sums_of(w.soft).mass, whole);
}

/// Its support is cut off, far from what stays of the lower one.
TEST_P(Box2dFracture, WhatSleepsOnAPieceThatVanishesFalls) {
  World2d w(9.81f, GetParam());
  w.add_box({0, -0.5f}, {20, 0.5f});
  w.soft.let_sleep(SleepSettings{});
  SoftBodySettings firm{.cell_size = 0.1f, .half_width = 2, .density = 100, .alpha = 0.9f, .damping = 0.2f};
  SoftBodySettings crumbs = firm;
  crumbs.fracture = Fracture{.least_cells = 13};
  SoftBody<2>& slab = w.soft.add(rectangle_model({20, 2}, crumbs), {0, 0.06f});
  SoftBody<2>& box = w.soft.add(rectangle_model({4, 2}, firm), {-0.7f, 0.37f});
  b2Body* const rigid = w.add_box({-0.7f, 0.8f}, {0.15f, 0.08f}, 100);
  for (int i = 0; i < 1200 && !(slab.asleep() && box.asleep()); ++i) w.soft.step(kStep2d);
  ASSERT_TRUE(slab.asleep() && box.asleep());
  const float before = box.centre_of_mass().y(), rigid_before = rigid->GetPosition().y;
  EXPECT_TRUE(w.soft.cut(slab, Cut2d::line({-0.399f, 0}, {1, 0})).empty());
  EXPECT_EQ(slab.model().lattice().cells.size(), 28u);
  w.run(0.5f);
  EXPECT_LT(box.centre_of_mass().y(), before - 0.1f);
  EXPECT_LT(rigid->GetPosition().y, rigid_before - 0.1f);
}

TEST_P(Box2dFracture, PiecesTouchWhatTheWholeMay) {
  World2d w(9.81f, GetParam());
  w.add_box({0, -0.5f}, {20, 0.5f});
  SoftBody<2>& disc = w.soft.add(disc_model(4, brittle_2d(1)), {0, 1});
  w.soft.set_filter(disc, {.group = 2, .mask = 2});  // the floor is of group 1
  const auto pieces = w.soft.cut(disc, Cut2d::line(disc.centre_of_mass(), {1, 0}));
  ASSERT_EQ(pieces.size(), 1u);
  w.run(1);
  EXPECT_LT(disc.centre_of_mass().y(), -2);
  EXPECT_LT(pieces[0]->centre_of_mass().y(), -2);
}

/// Each body has a group of collision of its own. A step cannot refuse to break a body.
TEST(Box2dFractureOfCircles, ABodyStaysWholeWhileItsPiecesFindNoGroups) {
  if (kSlowBuild) GTEST_SKIP() << "32,768 bodies take too long with sanitizers";
  World2d w(0, ContactMethod::kSpheres);
  SoftBody<2>& bar = w.soft.add(rectangle_model({10, 1}, brittle_2d(0.02f)), {0, 2});
  const auto filler = rectangle_model({1, 1}, {.cell_size = 0.1f, .half_width = 1, .contacts = false});
  constexpr std::size_t kMost = 32768;
  while (w.soft.size() < kMost) w.soft.add(filler, {9, 9});
  EXPECT_THROW(w.soft.add(filler, {9, 9}), std::runtime_error);
  const Cut2d middle = Cut2d::line({0.01f, 2}, {1, 0});
  EXPECT_THROW(w.soft.cut(bar, middle), std::runtime_error);
  EXPECT_THROW(w.soft.begin_cut(bar, middle), std::runtime_error);
  for (std::size_t i = 0; i < bar.model().particles(); ++i)
    bar.add_particle_velocity(i, {bar.position(i).x() > 0 ? 6.0f : -6.0f, 0});
  const auto step = [&] {
    for (int i = 0; i < 3; ++i) w.soft.step(kStep2d);
  };
  EXPECT_NO_THROW(step());
  EXPECT_EQ(w.soft.size(), kMost);
  EXPECT_TRUE(w.soft.poll_broken().empty());
  for (int i = 0; i < 20; ++i) w.soft.remove(w.soft[w.soft.size() - 1]);
  step();
  EXPECT_EQ(w.soft.poll_broken().size(), 1u);
  EXPECT_GT(w.soft.size(), kMost - 20);
}

TEST_P(Box2dFracture, WhatIsRemovedIsNotNamed) {
  World2d w(0, GetParam());
  SoftBody<2>& bar = w.soft.add(rectangle_model({10, 1}, {.cell_size = 0.1f, .half_width = 1}), {0, 2});
  const auto first = w.soft.cut(bar, Cut2d::line({0.101f, 2}, {1, 0}));
  ASSERT_EQ(first.size(), 1u);
  const auto second = w.soft.cut(*first[0], Cut2d::line({0.301f, 2}, {1, 0}));
  ASSERT_EQ(second.size(), 1u);
  w.soft.remove(*first[0]);
  const auto broken = w.soft.poll_broken();
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].body, &bar);
  EXPECT_TRUE(broken[0].pieces.empty());
  EXPECT_EQ(broken[0].particles_before.size(), 1u);
  EXPECT_EQ(w.soft.size(), 2u);
  EXPECT_THROW(w.soft.cut(*first[0], Cut2d::line({0, 0}, {1, 0})), std::invalid_argument);
  EXPECT_THROW(w.soft.cut(bar, Cut2d::stroke({0, 0}, {0, 0})), std::invalid_argument);
}

/// The body that a program assigns may be of any other model; attachments end, as their particles are no more.
TEST_P(Box2dFracture, ACopyBringsAWholeBodyBack) {
  World2d w(9.81f, GetParam());
  w.add_box({0, -0.5f}, {20, 0.5f});
  SoftBody<2>& disc = w.soft.add(disc_model(6, brittle_2d(0.03f)), {0, 2});
  const SoftBody<2> saved = disc;
  w.run(2);
  ASSERT_GT(w.soft.size(), 1u);
  while (w.soft.size() > 1) w.soft.remove(w.soft[w.soft.size() - 1]);
  const AttachmentId held = w.soft.attach(disc, Patch<2>::of_surface(disc.centre_of_mass(), 1));
  disc = saved;
  // What is attached from now on is the new body, and stays.
  const AttachmentId again = w.soft.attach(disc, Patch<2>::of_surface(disc.centre_of_mass(), 1));
  w.soft.step(kStep2d);
  EXPECT_FALSE(w.soft.attachment(held));
  EXPECT_TRUE(w.soft.attachment(again));
  w.soft.detach(again);
  EXPECT_EQ(disc.model().particles(), saved.model().particles());
  w.run(2);
  EXPECT_GT(w.soft.size(), 1u);
  expect_finite(w.soft);
}

/// Hits, cuts, attachments and removals in any order. With the last seeds small pieces vanish.
TEST_P(Box2dFracture, RandomBreaksLeaveNoNanNoDanglingReferenceAndNoMoreEnergy) {
  constexpr std::uint32_t kSeeds = 8, kMoreSeeds = 4;
  std::size_t vanished = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds + kMoreSeeds; ++seed) {
    std::mt19937 random(seed);
    const auto number = [&](float low, float high) {
      return std::uniform_real_distribution<float>(low, high)(random);
    };
    const auto vector = [&](float most) {
      const float x = number(-most, most);
      return Vector2f(x, number(-most, most));
    };
    World2d w(0, GetParam());
    const auto energy = [&] {
      double sum = 0;
      for (std::size_t b = 0; b < w.soft.size(); ++b)
        for (std::size_t i = 0; i < w.soft[b].positions().size(); ++i)
          sum += 0.5 * double{w.soft[b].model().masses()[i]} *
                 w.soft[b].velocities()[i].cast<double>().squaredNorm();
      return sum;
    };
    if (seed % 3 == 0) w.soft.let_sleep(SleepSettings{});
    for (int i = 0; i < 4; ++i) {
      SoftBodySettings settings = brittle_2d(number(0.01f, 0.15f));
      settings.fracture->least_cells = seed <= kSeeds ? 1 : 4;
      if (random() % 2 == 0) settings.fracture->turn = number(0.05f, 0.5f);
      settings.alpha = number(0.3f, 0.9f);
      const auto model = random() % 2 == 0 ? disc_model(3 + static_cast<int>(random() % 4), settings)
                                           : rectangle_model({9, 3}, settings);
      w.soft.add(model, {1.5f * static_cast<float>(i), 0});
    }
    std::vector<AttachmentId> attachments;
    double most = 0;
    for (int i = 0; i < 150; ++i) {
      SoftBody<2>& body = w.soft[random() % w.soft.size()];
      const Vector2f at = body.position(random() % body.positions().size());
      switch (random() % 8) {
        case 0: {
          const double before = energy();
          const Vector2f by = vector(6);
          for (std::size_t p = 0; p < body.positions().size(); ++p)
            if ((body.position(p) - at).norm() < 0.2f) body.add_particle_velocity(p, by);
          most = std::max(most, before) + std::max(0.0, energy() - before);
          break;
        }
        case 1:
          w.soft.cut(body, Cut2d::line(at, vector(1) + Vector2f(1e-3f, 0)));
          break;
        case 2:
          w.soft.begin_cut(body, Cut2d::stroke(at, vector(0.5f) + Vector2f(1e-3f, 0)));
          break;
        case 3:
          attachments.push_back(w.soft.attach(body, Patch<2>::of_surface(at, 0.35f)));
          break;
        case 4: {
          SoftBody<2>& other = w.soft[random() % w.soft.size()];
          if (&other == &body) break;
          const Vector2f there = other.position(random() % other.positions().size());
          AttachmentSettings<2> rope;
          rope.kind = AttachmentKind::kRope;
          attachments.push_back(w.soft.attach(body, Patch<2>::of_surface(at, 0.35f), other,
                                              Patch<2>::of_surface(there, 0.35f), rope));
          break;
        }
        case 5:
          if (w.soft.size() > 3) w.soft.remove(body);
          break;
        case 6:
          if (attachments.empty()) break;
          w.soft.detach(attachments.back());
          attachments.pop_back();
          break;
        default:
          w.soft.begin_ahead(kStep2d);
      }
      w.soft.step(kStep2d);
      w.soft.step(kStep2d);
      if (i % 3 == 0)
        for (const BrokenSoftBody2d& broken : w.soft.poll_broken()) vanished += broken.vanished;
      for (const EndedAttachment& ended : w.soft.poll_ended_attachments()) std::erase(attachments, ended.id);
      const double now = energy();
      ASSERT_TRUE(std::isfinite(now)) << "seed " << seed << ", step " << i;
      EXPECT_LT(now, 1.1 * most + 1) << "seed " << seed << ", step " << i;
    }
  }
  EXPECT_GT(vanished, 0u);
}

/// Bodies of a thousand cells are broken to single ones, and these are still bodies.
TEST_P(Box2dFracture, ABodyBrokenToSingleCellsIsStillASetOfBodies) {
  World2d w(9.81f, GetParam());
  w.add_box({0, -0.5f}, {20, 0.5f});
  SoftBody<2>& block = w.soft.add(rectangle_model({8, 8}, {.cell_size = 0.1f, .half_width = 1}), {0, 0.2f});
  const double mass = double{block.model().mass()};
  for (int i = 1; i < 8; ++i)
    for (const bool upright : {true, false}) {
      const float at = 0.1f * static_cast<float>(i) + 0.001f;
      for (std::size_t b = 0, count = w.soft.size(); b < count; ++b)
        w.soft.cut(w.soft[b],
                   upright ? Cut2d::line({at - 0.4f, 0}, {1, 0}) : Cut2d::line({0, at + 0.2f}, {0, 1}));
    }
  EXPECT_EQ(w.soft.size(), 64u);
  w.run(3);
  expect_finite(w.soft);
  EXPECT_NEAR(sums_of(w.soft).mass, mass, 1e-5 * mass);
  for (std::size_t b = 0; b < w.soft.size(); ++b) {
    EXPECT_GT(w.soft[b].bounds().low.y(), -0.01f);
    EXPECT_LT(w.soft[b].bounds().high.y(), 1.5f);
  }
}

/// The impact that breaks a body was lost: what its touches had been told was forgotten with the whole.
TEST(Box2dFractureEvents, TellOfAllImpulsesWhileABodyBreaks) {
  World2d w(9.81f, ContactMethod::kSurface);
  w.add_box({0, -0.5f}, {0.1f, 0.5f});
  w.soft.watch_contacts(true);
  SoftBodySettings settings = brittle_2d(0.1f);
  settings.friction = 0;  // events have the impulses along normals
  SoftBody<2>& bar = w.soft.add(rectangle_model({10, 2}, settings), {0, 0.1f});
  const double mass = double{bar.model().mass()};
  bar.add_velocity({0, -6});
  double told = 0;
  for (int i = 0; i < 60; ++i) {
    w.soft.step(kStep2d);
    for (const ContactEvent2d& event : w.soft.poll_contact_events())
      if (event.other == nullptr) told += double{event.impulse} * double{event.normal.y()};
  }
  EXPECT_GT(w.soft.size(), 2u);
  const double given = sums_of(w.soft).momentum.y() + mass * (6 + 60 * double{kStep2d} * 9.81);
  EXPECT_GT(given, 0.3 * mass * 6);
  EXPECT_NEAR(told, given, 0.02 * given);
}

/// For the program the body goes on, as one of its pieces: a goal must not count twice.
TEST(Box2dFractureEvents, ABodyThatIsCutStillTouchesWhatItTouched) {
  World2d w(9.81f, ContactMethod::kSurface);
  const b2Body* const floor = w.add_box({0, -0.5f}, {5, 0.5f});
  b2Body* const goal = w.add_box({0, 0.2f}, {2, 0.2f});
  goal->GetFixtureList()->SetSensor(true);
  w.soft.watch_contacts(true);
  SoftBody<2>& block = w.soft.add(rectangle_model({6, 3}, brittle_2d(1)), {0, 0.05f});
  w.run(1);
  w.soft.poll_contact_events();
  const std::vector<SoftBody<2>*> pieces = w.soft.cut(block, Cut2d::line({0.01f, 0}, {1, 0}));
  ASSERT_EQ(pieces.size(), 1u);
  w.soft.step(kStep2d);
  int with_floor = 0, in_goal = 0;
  for (const ContactEvent2d& event : w.soft.poll_contact_events()) {
    EXPECT_NE(event.kind, ContactEvent2d::Kind::kEnd);
    if (event.body != &block || event.other != nullptr) continue;
    EXPECT_EQ(event.kind, ContactEvent2d::Kind::kPersist);
    with_floor += event.rigid == floor ? 1 : 0;
    in_goal += event.rigid == goal ? 1 : 0;
  }
  EXPECT_EQ(with_floor, 1);
  EXPECT_EQ(in_goal, 1);
}

}  // namespace
}  // namespace softcell::ppu
