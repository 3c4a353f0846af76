// Bodies that break in a Bullet world.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "../contacts/contact_world.h"
#include "crack_depth.h"
#include "fracture_checks.h"
#include "ppu/fracture/cracks.h"
#include "ppu/surfaces/crack_sides.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_runtime.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

void run(ContactWorld& world, int substeps) {
  for (int i = 0; i < substeps; ++i) world.world.stepSimulation(kStep, 0);
}

SoftBodySettings brittle(float cell_size, float stretch) {
  SoftBodySettings settings{.cell_size = cell_size, .half_width = 2, .alpha = 0.5f, .damping = 0.1f};
  settings.fracture = Fracture{.stretch = stretch};
  return settings;
}

std::shared_ptr<const SoftBodyModel<3>> brittle_ball(float stretch, std::optional<float> turn = {}) {
  SoftBodySettings settings = brittle(0.125f, stretch);
  settings.fracture->turn = turn;
  return make_soft_body_model(make_sphere(0.5f, 3), settings);
}

std::uint64_t hash_of(const BulletSoftBodies& bodies) {
  std::uint64_t hash = bodies.size();
  for (std::size_t b = 0; b < bodies.size(); ++b) hash = state_hash(bodies[b], hash);
  return hash;
}

Momenta momenta_of(const BulletSoftBodies& bodies) {
  Momenta sum;
  for (std::size_t b = 0; b < bodies.size(); ++b) sum.add(bodies[b]);
  return sum;
}

/// A bar of 12 cells along x, from its weak middle on, that a weld at each end pulls apart.
TEST(BulletFracture, ABarUnderTensionBreaksWhereItIsWeakAtTheStretchStated) {
  constexpr float kStretch = 0.1f, kWeak = 0.5f, kCell = 0.1f;
  ContactWorld world({0, 0, 0});
  SoftBodySettings settings = brittle(kCell, kStretch);
  settings.half_width = 1;
  const auto model = make_soft_body_model(
      make_box({1.2f, 0.2f, 0.2f}, 0.1f), settings,
      [](const Vector3f& at) { return std::abs(at.x() - 0.15f) < 0.06f ? kWeak : 1.0f; });
  SoftBody<3>& bar = world.bodies.add(model, {0, 0, 0});
  const auto& lattice = model->lattice();
  std::vector<std::uint32_t> left, right;
  for (std::uint32_t i = 0; i < lattice.particles.size(); ++i) {
    if (lattice.particles[i].x() <= 1) left.push_back(i);
    if (lattice.particles[i].x() >= 11) right.push_back(i);
  }
  const AttachmentId wall = world.bodies.attach(bar, Patch<3>::of_particles(left));
  const AttachmentId hand = world.bodies.attach(bar, Patch<3>::of_particles(right));
  const Vector3f from(0.55f, 0, 0);
  world.bodies.move_attachment(hand, from + Vector3f(0.3f, 0, 0), Eigen::Quaternionf::Identity(), 15);
  /// The mean of the links between the cells whose low corners are at x and x + 1.
  const auto elongation = [&](int x) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < bar.model().lattice().particles.size(); ++i) {
      const int at = bar.model().lattice().particles[i].x();
      const double share = at == x ? -0.5 : at == x + 2 ? 0.5 : 0;
      sum += share * double{bar.position(i).x()};
      count += at == x ? 1 : 0;
    }
    return sum / count / double{kCell} - 1;
  };
  double before = 0;
  for (int i = 0; i < 15 * 120 && world.bodies.size() == 1; ++i) {
    before = elongation(7);
    run(world, 1);
  }
  ASSERT_EQ(world.bodies.size(), 2u);
  // Weak are the cells that begin at x = 7 (from 0.1 to 0.2 m): the faces on either side of them break, one of them first.
  EXPECT_NEAR(before, double{kStretch * kWeak}, 0.05 * double{kStretch * kWeak});
  const auto cells = [&](std::size_t b) { return world.bodies[b].model().lattice().cells.size() / 4; };
  EXPECT_TRUE((cells(0) == 7 && cells(1) == 5) || (cells(0) == 8 && cells(1) == 4))
      << cells(0) << " and " << cells(1);
  // Both ends still hold.
  EXPECT_TRUE(world.bodies.attachment(wall) && world.bodies.attachment(hand));
  EXPECT_TRUE(world.bodies.poll_ended_attachments().empty());
  const auto broken = world.bodies.poll_broken();
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].body, &world.bodies[0]);
  ASSERT_EQ(broken[0].pieces.size(), 1u);
  EXPECT_EQ(broken[0].pieces[0], &world.bodies[1]);
  EXPECT_GE(broken[0].faces, 4u);
  EXPECT_TRUE(world.bodies.poll_broken().empty());
  // The piece that is pulled follows the hand, the other one stays with the wall.
  run(world, 600);
  EXPECT_EQ(world.bodies.size(), 2u);
  float gap = 0;
  for (std::size_t b = 0; b < 2; ++b)
    gap = std::max(gap, world.bodies[b].bounds().low.x() - world.bodies[1 - b].bounds().high.x());
  EXPECT_GT(gap, 0.02f);
}

TEST(BulletFracture, ABentBarBreaksByItsTurn) {
  for (const float turn : {0.1f, 3.0f}) {
    ContactWorld world({0, -9.81f, 0});
    SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1, .alpha = 0.2f, .damping = 0.2f};
    settings.fracture = Fracture{.turn = turn};
    const auto model = make_soft_body_model(make_box({1.6f, 0.1f, 0.1f}, 0.1f), settings);
    SoftBody<3>& bar = world.bodies.add(model, {0, 2, 0});
    world.bodies.attach(bar, Patch<3>::of_surface({-0.75f, 2, 0}, 0.1f));
    run(world, 240);
    if (turn < 1)
      EXPECT_GT(world.bodies.size(), 1u);
    else
      EXPECT_EQ(world.bodies.size(), 1u);
  }
}

TEST(BulletFracture, ABallThatFallsBreaksIntoValidPiecesAndKeepsItsMass) {
  ContactWorld world;
  world.add(std::make_unique<btBoxShape>(btVector3(10, 0.5f, 10)), 0, {0, -0.5f, 0});
  const SoftBody<3>& ball = world.bodies.add(brittle_ball(0.05f), {0, 3, 0});
  const double mass = double{ball.model().mass()};
  run(world, 240);
  EXPECT_GT(world.bodies.size(), 3u);
  double sum = 0, drawn = 0;
  for (std::size_t b = 0; b < world.bodies.size(); ++b) {
    const SoftBody<3>& piece = world.bodies[b];
    sum += double{piece.model().mass()};
    drawn += volume(piece.model().mesh());
    EXPECT_EQ(unmet_sides(piece.model().mesh()), 0u);
    for (const Vector3f& x : piece.positions()) EXPECT_TRUE(x.allFinite());
    EXPECT_GT(ContactWorld::lowest_drawn(piece), -0.03f);
  }
  EXPECT_NEAR(sum, mass, 1e-5 * mass);
  EXPECT_NEAR(drawn, volume(make_sphere(0.5f, 3)), 1e-4);
}

/// Two brittle balls meet in the air, without gravity.
void expect_both_momenta(SolverFactory* solvers) {
  ContactWorld world({0, 0, 0}, solvers);
  const auto model = brittle_ball(0.04f, 0.2f);
  world.bodies.add(model, {-0.8f, 0.1f, 0}).add_velocity({4, 0, 0});
  world.bodies.add(model, {0.8f, -0.1f, 0.05f}).add_velocity({-4, 0, 0});
  const Momenta before = momenta_of(world.bodies);
  const double scale = before.mass * 4;
  std::size_t most = 0;
  for (int i = 0; i < 1000; ++i) {
    const Momenta earlier = momenta_of(world.bodies);
    const std::size_t pieces = world.bodies.size();
    run(world, 1);
    most = std::max(most, world.bodies.size());
    if (world.bodies.size() == pieces) continue;
    const Momenta now = momenta_of(world.bodies);
    EXPECT_NEAR(now.mass, earlier.mass, 1e-6 * earlier.mass);
  }
  EXPECT_GT(most, 4u);
  const Momenta after = momenta_of(world.bodies);
  // Pieces are up to 30 m away by then.
  // Cells along cracks touch in each substep: a sum that lost digits there would show.
  EXPECT_LT((after.momentum - before.momentum).norm(), 2e-6 * scale);
  EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), 1e-5 * scale * 30);
}

/// The test winds the triangles of the ground both ways.
TEST(BulletFracture, PiecesStayOnTheirSideOfTriangles) {
  for (const bool upwards : {true, false}) {
    SCOPED_TRACE(upwards);
    btTriangleMesh triangles;
    const btVector3 a(-20, 0, -20), b(-20, 0, 20), c(20, 0, 20), d(20, 0, -20);
    triangles.addTriangle(a, upwards ? b : c, upwards ? c : b);
    triangles.addTriangle(a, upwards ? c : d, upwards ? d : c);
    ContactWorld world;
    world.add(std::make_unique<btBvhTriangleMeshShape>(&triangles, true), 0, {0, 0, 0});
    SoftBody<3>& ball = world.bodies.add(brittle_ball(0.03f), {0, 0.6f, 0});
    ball.add_velocity({0, -12, 0});
    run(world, 240);
    EXPECT_GT(world.bodies.size(), 3u);
    for (std::size_t piece = 0; piece < world.bodies.size(); ++piece)
      EXPECT_GT(ContactWorld::lowest_drawn(world.bodies[piece]), -0.03f) << piece;
  }
}

TEST(BulletFracture, KeepsBothMomentaForAThousandSteps) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  expect_both_momenta(nullptr);
}

TEST(BulletFracture, KeepsBothMomentaForAThousandStepsOnSpes) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  SpeRuntime spes({.spes = 2});
  expect_both_momenta(&spes);
}

/// Two ends that fly apart. What contacts of the pieces do to angular momentum is left out.
TEST(BulletFracture, ATornBodyKeepsBothMomentaForAThousandSteps) {
  ContactWorld world({0, 0, 0});
  SoftBody<3>& ball = world.bodies.add(brittle_ball(0.03f), {0, 0, 0});
  std::mt19937 random(5);
  for (std::size_t i = 0; i < ball.positions().size(); ++i) {
    const Vector3f x = ball.position(i);
    ball.add_particle_velocity(
        i, (x.x() > 0.1f ? 3.0f : -1.0f) * Vector3f(1, 0.2f, 0) + Vector3f(0, 2, 1).cross(x));
  }
  const Momenta before = momenta_of(world.bodies);
  Momenta now = before;
  Eigen::Vector3d by_contacts = Eigen::Vector3d::Zero();
  int free = 0;
  std::vector<Contact> contacts;
  for (int i = 0; i < 1000; ++i) {
    const Momenta earlier = now;
    const std::size_t bodies = world.bodies.size();
    run(world, 1);
    now = momenta_of(world.bodies);
    contacts.clear();
    world.bodies.append_contacts(contacts);
    if (contacts.empty())
      ++free;
    else
      by_contacts += now.angular_momentum - earlier.angular_momentum;
    if (bodies == world.bodies.size()) continue;
    // The break itself only shares out what there is.
    EXPECT_LT((now.momentum - earlier.momentum).norm(), 1e-6 * before.mass * 3);
    EXPECT_LT((now.angular_momentum - earlier.angular_momentum).norm(), 1e-6 * before.mass * 3);
  }
  EXPECT_GT(world.bodies.size(), 1u);
  EXPECT_GT(free, 500);
  EXPECT_NEAR(now.mass, before.mass, 1e-6 * before.mass);
  EXPECT_LT((now.momentum - before.momentum).norm(), 1e-5 * before.mass * 3);
  // Pieces are up to 25 m from the origin by then, where a float is 2e-6 m.
  EXPECT_LT((now.angular_momentum - by_contacts - before.angular_momentum).norm(),
            1e-5 * before.mass * 3 * 25);
}

TEST(BulletFracture, HasTheSameBitsForAnyNumberOfSpesAndSchedule) {
  const auto fall = [](SolverFactory& spes) {
    ContactWorld world({0, -9.81f, 0}, &spes);
    world.add(std::make_unique<btBoxShape>(btVector3(10, 0.5f, 10)), 0, {0, -0.5f, 0});
    const auto model = brittle_ball(0.06f, 0.5f);
    world.bodies.add(model, {0, 2, 0});
    world.bodies.add(model, {0.3f, 3.5f, 0.1f});
    run(world, 140);
    EXPECT_GT(world.bodies.size(), 3u);
    return hash_of(world.bodies);
  };
  SpeRuntime one({.spes = 1}), lazy({.spes = 6, .schedule = dma::parse_schedule("lazy")});
  const std::uint64_t expected = fall(one);
  for (int spes = kSlowBuild ? 6 : 2; spes <= 6; ++spes) {
    SpeRuntime some({.spes = spes});
    EXPECT_EQ(fall(some), expected) << spes;
  }
  EXPECT_EQ(fall(lazy), expected);
  if (!kSlowBuild) {
    EXPECT_EQ(fall(one), expected);
  }
}

/// A crack inside leaves a body as it was. Where a rotation is sought from shows in its last bits.
TEST(BulletFracture, APieceGoesOnWithTheRotationsOfItsRegions) {
  const auto run_with = [](SolverFactory* solvers, const SoftBodySettings& settings, const Vector3f& size,
                           bool cracks) {
    ContactWorld world({0, 0, 0}, solvers);
    SoftBody<3>& body = world.add(make_box(size, settings.cell_size), settings, {0, 0, 0});
    for (std::size_t i = 0; i < body.positions().size(); ++i) {
      const Vector3f x = body.position(i);
      body.set_particle(i, {x.x() + 0.1f * x.y() * x.y(), -x.z(), x.y() + 0.1f * x.x() * x.z()},
                        {x.y(), 0.2f * x.x(), 0});
    }
    body.translate({0, 0, 0});  // so that couplings notice
    run(world, 3);
    if (cracks) {
      const auto& lattice = body.model().lattice();
      Vector3f middle = Vector3f::Zero(), across = Vector3f::Zero();  // of a face in the body's middle
      for (std::uint32_t i = 0; i < body.positions().size(); ++i) {
        const Vector3f from_middle = lattice.rest_position(i);
        if ((from_middle.array().abs() - 0.6f * settings.cell_size).maxCoeff() > 0) continue;
        middle += body.position(i) / 8;
        across += (from_middle.x() > 0 ? 1.0f : -1.0f) * body.position(i) / 8;
      }
      const Vector3f side = 0.4f * settings.cell_size * across.unitOrthogonal();
      const Vector3f face = middle + across;
      EXPECT_TRUE(world.bodies
                      .cut(body, Cut::stroke(face - side / 2 - across.normalized().cross(side) / 2, side,
                                             across.normalized().cross(side)))
                      .empty());
      EXPECT_TRUE(body.model().is_piece());
      const std::vector<bool>& is_broken = body.model().cracks().is_broken;
      EXPECT_EQ(std::count(is_broken.begin(), is_broken.end(), true), 1);
    }
    run(world, 3);
    return state_hash(body);
  };
  SpeRuntime spes({.spes = 2});
  for (const Vector3f& size : {Vector3f(0.7f, 0.5f, 0.5f), Vector3f(1.3f, 1.1f, 1.1f)}) {
    for (SolverFactory* const solvers :
         {static_cast<SolverFactory*>(nullptr), static_cast<SolverFactory*>(&spes)})
      EXPECT_EQ(run_with(solvers, brittle(0.1f, 1), size, true),
                run_with(solvers, brittle(0.1f, 1), size, false))
          << size.x() << (solvers != nullptr ? " on SPEs" : "");
  }
}

/// A bar along x with a crack from above down to its middle.
SoftBody<3>& cracked_bar(ContactWorld& world) {
  SoftBody<3>& bar = world.add(make_box({1.2f, 0.4f, 0.4f}, 0.1f), brittle(0.1f, 1), {0, 0, 0});
  EXPECT_TRUE(world.bodies.cut(bar, Cut::stroke({0.01f, 0.05f, -1}, {0, 1, 0}, {0, 0, 2})).empty());
  EXPECT_TRUE(bar.model().is_piece());
  return bar;
}

TEST(BulletFracture, CellsAlongACrackAreOfOneSideOrTheOther) {
  ContactWorld world({0, 0, 0});
  const SoftBody<3>& bar = cracked_bar(world);
  const Lattice<3>& lattice = bar.model().lattice();
  const std::vector<std::uint32_t> sides = crack_sides(lattice, bar.model().cracks());
  ASSERT_EQ(sides.size(), lattice.cells.size());
  std::set<std::uint32_t> left, right;
  std::size_t none = 0;
  const auto middle_of = [&](std::uint32_t cell) {
    return Vector3f(0.5f * (lattice.rest_position(lattice.corners[cell][0]) +
                            lattice.rest_position(lattice.corners[cell][7])));
  };
  for (std::uint32_t c = 0; c < sides.size(); ++c) {
    const Vector3f middle = middle_of(c);
    const bool along = std::abs(middle.x()) < 0.1f && middle.y() > 0;
    EXPECT_EQ(sides[c] != 0, along) << middle.transpose();
    if (sides[c] == 0) ++none;
    if (sides[c] != 0) (middle.x() < 0 ? left : right).insert(sides[c]);
  }
  EXPECT_GT(none, 0u);
  ASSERT_EQ(left.size(), 1u);
  ASSERT_EQ(right.size(), 1u);
  EXPECT_NE(*left.begin(), *right.begin());
  for (std::uint32_t a = 0; a < sides.size(); ++a) {
    for (std::uint32_t b = 0; b < sides.size(); ++b) {
      if (sides[a] != *left.begin() || sides[b] != *right.begin()) continue;
      const bool both_at_the_end = middle_of(a).y() < 0.1f && middle_of(b).y() < 0.1f;
      const bool neighbours = std::abs(middle_of(a).z() - middle_of(b).z()) < 0.15f;
      EXPECT_EQ(are_parted(lattice, sides, a, b), !(both_at_the_end && neighbours));
      EXPECT_EQ(are_parted(lattice, sides, b, a), are_parted(lattice, sides, a, b));
    }
  }
  EXPECT_TRUE(crack_sides(bar.model().whole()->lattice(), bar.model().whole()->cracks()).empty());
}

TEST(BulletFracture, TheSidesOfACrackInOnePieceTouchEachOther) {
  SpeRuntime spes({.spes = 2});
  for (SolverFactory* const solvers :
       {static_cast<SolverFactory*>(nullptr), static_cast<SolverFactory*>(&spes)}) {
    ContactWorld world({0, 0, 0}, solvers);
    SoftBody<3>& bar = cracked_bar(world);
    // Bent, so that the crack closes.
    for (std::size_t i = 0; i < bar.positions().size(); ++i) {
      const Vector3f x = bar.position(i);
      bar.add_particle_velocity(i, {(x.x() > 0 ? -10 : 10) * std::max(0.0f, x.y()), 20 * x.x() * x.x(), 0});
    }
    const Momenta before = momenta_of(world.bodies);
    float deepest = 0;
    for (int i = 0; i < 60; ++i) {
      run(world, 1);
      deepest = std::max(deepest, deepest_in_crack(bar));
    }
    ASSERT_EQ(world.bodies.size(), 1u);
    EXPECT_GT(deepest, 0);  // 1.7 cells if they did not touch
    EXPECT_LT(deepest, 0.35f) << (solvers != nullptr ? "on SPEs" : "");
    EXPECT_LT(deepest_in_crack(bar), 0.1f);
    const Momenta now = momenta_of(world.bodies);
    EXPECT_LT((now.momentum - before.momentum).norm(), 1e-4 * before.mass);
    EXPECT_LT((now.angular_momentum - before.angular_momentum).norm(), 1e-3 * before.mass);
  }
}

/// A crack that nothing presses together does nothing.
TEST(BulletFracture, ABodyWithACrackLiesStill) {
  ContactWorld world({0, 0, 0});
  const SoftBody<3>& bar = cracked_bar(world);
  run(world, 60);
  EXPECT_LT(bar.mean_speed(), 1e-4f);
  EXPECT_LT(bar.deformation(), 1e-4f);
}

/// The thread that makes pieces has all the time in the world, or none: no result depends on it.
TEST(BulletFracture, ABodyStaysWholeUntilItsPiecesAreDue) {
  const auto tear = [](std::chrono::milliseconds pause) {
    ContactWorld world({0, 0, 0});
    SoftBody<3>& ball = world.bodies.add(brittle_ball(0.03f), {0, 0, 0});
    EXPECT_GT(ball.positions().size(), 100u);
    EXPECT_LT(ball.positions().size(), 1000u);
    for (std::size_t i = 0; i < ball.positions().size(); ++i)
      ball.add_particle_velocity(i, Vector3f(ball.position(i).x() > 0.1f ? 3.0f : -3.0f, 0, 0));
    int breaking = 0;
    for (int i = 0; i < 60 && world.bodies.size() == 1; ++i) {
      run(world, 1);
      breaking += world.bodies.is_breaking(ball) ? 1 : 0;
      std::this_thread::sleep_for(pause);
    }
    EXPECT_GT(world.bodies.size(), 1u);
    EXPECT_EQ(breaking, 2);
    EXPECT_FALSE(world.bodies.is_breaking(ball));
    run(world, 20);
    return hash_of(world.bodies);
  };
  EXPECT_EQ(tear(std::chrono::milliseconds(0)), tear(std::chrono::milliseconds(30)));
}

/// Bodies of more than 100 particles are tested in the next substep. Nobody who cuts before has to know.
TEST(BulletFracture, ACutFindsWhatTheSubstepBeforeHasBroken) {
  const auto ball_that_tears = [](ContactWorld& world) -> SoftBody<3>& {
    SoftBody<3>& ball = world.bodies.add(brittle_ball(0.03f), {0, 0, 0});
    for (std::size_t i = 0; i < ball.positions().size(); ++i)
      ball.add_particle_velocity(i, Vector3f(ball.position(i).x() > 0.1f ? 3.0f : -3.0f, 0, 0));
    return ball;
  };
  ContactWorld world({0, 0, 0}), other({0, 0, 0});
  const SoftBody<3>&ball = ball_that_tears(world), &same = ball_that_tears(other);
  int substeps = 0;
  for (; substeps < 60 && !world.bodies.is_breaking(ball); ++substeps) run(world, 1);
  ASSERT_LT(substeps, 60);
  const Cut elsewhere = Cut::plane({9, 0, 0}, {1, 0, 0});
  run(other, substeps - 1);
  EXPECT_TRUE(other.bodies.cut(same, elsewhere).empty());
  EXPECT_EQ(other.bodies.size(), 1u) << "it has not broken yet";
  run(other, 1);
  EXPECT_TRUE(other.bodies.cut(same, elsewhere).empty());
  EXPECT_GT(other.bodies.size(), 1u);
  run(world, 3);
  EXPECT_EQ(world.bodies.size(), other.bodies.size());
}

TEST(BulletFracture, ACutThatBeginsHasItsPiecesLater) {
  ContactWorld world({0, 0, 0});
  SoftBodySettings jelly{.cell_size = 0.125f, .half_width = 1};
  SoftBody<3>& ball = world.bodies.add(make_soft_body_model(make_sphere(0.5f, 3), jelly), {0, 0, 0});
  const Cut half = Cut::plane({0.01f, 0, 0}, {1, 0, 0});
  EXPECT_FALSE(world.bodies.begin_cut(ball, Cut::plane({2, 0, 0}, {1, 0, 0})));
  EXPECT_TRUE(world.bodies.begin_cut(ball, half));
  EXPECT_TRUE(world.bodies.is_breaking(ball));
  EXPECT_TRUE(world.bodies.poll_broken().empty());
  run(world, 3);
  EXPECT_FALSE(world.bodies.is_breaking(ball));
  const auto broken = world.bodies.poll_broken();
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].body, &ball);
  ASSERT_EQ(broken[0].pieces.size(), 1u);
  // The same pieces as at once.
  ContactWorld other({0, 0, 0});
  SoftBody<3>& whole = other.bodies.add(make_soft_body_model(make_sphere(0.5f, 3), jelly), {0, 0, 0});
  ASSERT_EQ(other.bodies.cut(whole, half).size(), 1u);
  for (std::size_t b = 0; b < 2; ++b)
    EXPECT_EQ(world.bodies[b].positions().size(), other.bodies[b].positions().size());
}

/// A body that is about to break is assigned, cut or removed.
TEST(BulletFracture, WhatHappensToABodyThatIsBreakingIsKept) {
  const auto with_breaking_ball = [](const auto& work) {
    ContactWorld world({0, 0, 0});
    SoftBody<3>& ball = world.bodies.add(brittle_ball(0.03f), {0, 0, 0});
    const SoftBody<3> saved = ball;
    for (std::size_t i = 0; i < ball.positions().size(); ++i)
      ball.add_particle_velocity(i, Vector3f(ball.position(i).x() > 0.1f ? 3.0f : -3.0f, 0, 0));
    for (int i = 0; i < 60 && !world.bodies.is_breaking(ball); ++i) run(world, 1);
    ASSERT_TRUE(world.bodies.is_breaking(ball));
    work(world, ball, saved);
    run(world, 10);
    for (std::size_t b = 0; b < world.bodies.size(); ++b)
      for (const Vector3f& x : world.bodies[b].positions()) EXPECT_TRUE(x.allFinite());
  };
  with_breaking_ball([](ContactWorld& world, SoftBody<3>& ball, const SoftBody<3>& saved) {
    ball = saved;
    run(world, 10);
    EXPECT_EQ(world.bodies.size(), 1u);
    EXPECT_TRUE(world.bodies.poll_broken().empty());
  });
  with_breaking_ball([](ContactWorld& world, SoftBody<3>& ball, const SoftBody<3>&) {
    const auto pieces = world.bodies.cut(ball, Cut::plane(ball.centre_of_mass(), {0, 1, 0}));
    EXPECT_FALSE(pieces.empty());
    EXPECT_GT(world.bodies.size(), 2u);
    EXPECT_EQ(world.bodies.poll_broken().size(), 2u);
  });
  with_breaking_ball([](ContactWorld& world, SoftBody<3>& ball, const SoftBody<3>&) {
    world.bodies.remove(ball);
    run(world, 10);
    EXPECT_EQ(world.bodies.size(), 0u);
    EXPECT_TRUE(world.bodies.poll_broken().empty());
  });
  // The world goes while a break is under way.
  ContactWorld world({0, 0, 0});
  SoftBody<3>& ball = world.bodies.add(brittle_ball(0.03f), {0, 0, 0});
  EXPECT_TRUE(world.bodies.begin_cut(ball, Cut::plane({0, 0, 0}, {1, 0, 0})));
}

/// A piece hangs on a rope by particles that the whole body numbers in another way.
TEST(BulletFracture, AttachmentsEndWithAnAssignmentOfAnotherModel) {
  ContactWorld world({0, -9.81f, 0});
  SoftBody<3>& ball = world.bodies.add(brittle_ball(1e3f), {0, 0, 0});
  const SoftBody<3> saved = ball;
  ASSERT_FALSE(world.bodies.cut(ball, Cut::plane({0, 0, 0}, {1, 0, 0})).empty());
  world.bodies.attach(ball, Patch<3>::of_particles({0, 1, 2}));
  run(world, 2);
  ball = saved;
  run(world, 2);
  const std::vector<EndedAttachment> ended = world.bodies.poll_ended_attachments();
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].reason, EndedAttachment::Reason::kGone);
  // One of the new model, made before the next step, stays.
  SoftBody<3>& half = world.bodies.add(brittle_ball(1e3f), {5, 0, 0});
  ASSERT_FALSE(world.bodies.cut(half, Cut::plane({5, 0, 0}, {1, 0, 0})).empty());
  half = saved;
  world.bodies.attach(half, Patch<3>::of_surface({0, 0.3f, 0}, 0.2f));
  run(world, 2);
  EXPECT_TRUE(world.bodies.poll_ended_attachments().empty());
}

TEST(BulletFracture, RandomCutsOfAWorldThatGoesOnLeaveItValid) {
  SpeRuntime spes({.spes = 2});
  ContactWorld world({0, -9.81f, 0}, &spes);
  world.add(std::make_unique<btBoxShape>(btVector3(10, 0.5f, 10)), 0, {0, -0.5f, 0});
  world.bodies.let_sleep(SleepSettings{});
  SoftBodySettings jelly{.cell_size = 0.15f, .half_width = 1};
  const auto model = make_soft_body_model(make_torus(0.5f, 0.25f, 24, 12), jelly);
  world.bodies.add(model, {0, 0.6f, 0});
  world.bodies.add(model, {0.2f, 1.4f, 0.1f});
  const double mass = 2 * double{model->mass()};
  std::mt19937 random(17);
  std::uniform_real_distribution<float> number(-1, 1);
  const auto vector = [&] { return Vector3f(number(random), number(random), number(random)); };
  for (int i = 0; i < 60; ++i) {
    run(world, 4);
    const SoftBody<3>& body = world.bodies[random() % world.bodies.size()];
    world.bodies.cut(body, Cut::plane(body.centre_of_mass() + 0.1f * vector(), vector()));
    if (i % 7 == 3) world.bodies.begin_ahead(kStep);
    if (i % 5 == 4) world.bodies.poll_broken();
  }
  run(world, 60);
  double sum = 0;
  for (std::size_t b = 0; b < world.bodies.size(); ++b) {
    sum += double{world.bodies[b].model().mass()};
    for (const Vector3f& x : world.bodies[b].positions()) ASSERT_TRUE(x.allFinite());
  }
  EXPECT_NEAR(sum, mass, 1e-5 * mass);
  EXPECT_GT(world.bodies.size(), 20u);
}

TEST(BulletFracture, AttachmentsGoOnWithThePieceThatHasTheirPatch) {
  ContactWorld world({0, -9.81f, 0});
  SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1};
  SoftBody<3>& bar =
      world.bodies.add(make_soft_body_model(make_box({1, 0.1f, 0.1f}, 0.1f), settings), {0, 2, 0});
  const AttachmentId left = world.bodies.attach(bar, Patch<3>::of_surface({-0.45f, 2, 0}, 0.08f));
  const AttachmentId middle = world.bodies.attach(bar, Patch<3>::of_surface({0.1f, 2, 0}, 0.08f));
  const AttachmentId right = world.bodies.attach(bar, Patch<3>::of_surface({0.45f, 2, 0}, 0.08f));
  const auto pieces = world.bodies.cut(bar, Cut::plane({0.101f, 2, 0}, {1, 0, 0}));
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(world.bodies.attachment(left));
  EXPECT_FALSE(world.bodies.attachment(middle));
  EXPECT_TRUE(world.bodies.attachment(right));
  const auto ended = world.bodies.poll_ended_attachments();
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].id, middle);
  EXPECT_EQ(ended[0].reason, EndedAttachment::Reason::kBroken);
  run(world, 240);
  // Both hang, and their ends are where they were.
  EXPECT_NEAR(world.bodies.attachment_ends(right)->patch.y(), 2, 0.01f);
  EXPECT_NEAR(world.bodies.attachment_ends(left)->patch.y(), 2, 0.01f);
  world.bodies.remove(*pieces[0]);
  EXPECT_FALSE(world.bodies.attachment(right));
  run(world, 10);
}

/// Both ways, at once and by the thread that makes pieces: a bar of 10 cells loses its last 3, or with more cells across, 3 layers.
TEST(BulletFracture, PiecesOfFewerCellsThanStatedVanish) {
  SpeRuntime spes({.spes = 2});
  for (const int across : {1, 4})
    for (SolverFactory* const solvers :
         {static_cast<SolverFactory*>(nullptr), static_cast<SolverFactory*>(&spes)}) {
      SCOPED_TRACE(across);
      ContactWorld world({0, -9.81f, 0}, solvers);
      const auto layer = static_cast<std::uint32_t>(across * across);
      SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1};
      settings.fracture = Fracture{.least_cells = 3 * layer + 1};
      const float width = 0.1f * static_cast<float>(across);
      SoftBody<3>& bar =
          world.bodies.add(make_soft_body_model(make_box({1, width, width}, 0.1f), settings), {0, 2, 0});
      SoftBody<3>& other = world.bodies.add(bar.shared_model(), {0, 4, 0});
      ASSERT_EQ(bar.model().lattice().cells.size(), 10 * layer);
      EXPECT_EQ(bar.positions().size() > 100, across > 1);
      const float mass = bar.model().mass(), reach = 0.07f + 0.5f * width;
      const auto patch_at = [&](float x) { return Patch<3>::of_surface({x, 2, 0}, reach); };
      const auto other_patch = Patch<3>::of_surface({0.45f, 4, 0}, reach);
      AttachmentSettings<3> rope;
      rope.kind = AttachmentKind::kRope;
      const AttachmentId stays = world.bodies.attach(bar, patch_at(-0.45f));
      const AttachmentId torn = world.bodies.attach(bar, patch_at(0.2f));
      const AttachmentId gone = world.bodies.attach(bar, patch_at(0.45f));
      const AttachmentId gone_by_b = world.bodies.attach(other, other_patch, bar, patch_at(0.45f), rope);
      const AttachmentId of_other = world.bodies.attach(other, Patch<3>::of_surface({-0.45f, 4, 0}, reach));
      const Cut end = Cut::plane({0.201f, 2, 0}, {1, 0, 0});
      if (across == 1) {
        EXPECT_TRUE(world.bodies.cut(bar, end).empty());
      } else {
        EXPECT_TRUE(world.bodies.begin_cut(bar, end));
        EXPECT_TRUE(world.bodies.is_breaking(bar));
        run(world, 4);
        EXPECT_FALSE(world.bodies.is_breaking(bar));
      }
      EXPECT_EQ(world.bodies.size(), 2u);
      EXPECT_EQ(bar.model().lattice().cells.size(), 7 * layer);
      EXPECT_NEAR(bar.model().mass(), 0.7f * mass, 1e-5f * mass);
      const auto broken = world.bodies.poll_broken();
      ASSERT_EQ(broken.size(), 1u);
      EXPECT_EQ(broken[0].body, &bar);
      EXPECT_TRUE(broken[0].pieces.empty());
      EXPECT_EQ(broken[0].vanished, 1u);
      ASSERT_EQ(broken[0].particles_before.size(), 1u);
      EXPECT_EQ(broken[0].particles_before[0].size(), bar.positions().size());
      EXPECT_TRUE(world.bodies.attachment(stays) && world.bodies.attachment(of_other));
      std::map<std::uint32_t, EndedAttachment::Reason> ended;
      for (const EndedAttachment& one : world.bodies.poll_ended_attachments())
        ended[static_cast<std::uint32_t>(one.id)] = one.reason;
      const std::map<std::uint32_t, EndedAttachment::Reason> expected{
          {static_cast<std::uint32_t>(torn), EndedAttachment::Reason::kBroken},
          {static_cast<std::uint32_t>(gone), EndedAttachment::Reason::kGone},
          {static_cast<std::uint32_t>(gone_by_b), EndedAttachment::Reason::kGone}};
      EXPECT_EQ(ended, expected);
      run(world, 60);
      EXPECT_NEAR(world.bodies.attachment_ends(stays)->patch.y(), 2, 0.02f);
      for (const Vector3f& x : bar.positions()) EXPECT_TRUE(x.allFinite());
      world.bodies.remove(bar);
      world.bodies.remove(other);
      run(world, 2);
    }
}

TEST(BulletFracture, ABallThatFallsKeepsItsLargestPiecesOnly) {
  constexpr std::uint32_t kLeast = 12;
  ContactWorld world;
  world.add(std::make_unique<btBoxShape>(btVector3(10, 0.5f, 10)), 0, {0, -0.5f, 0});
  SoftBodySettings settings = brittle(0.125f, 0.05f);
  settings.fracture->least_cells = kLeast;
  const SoftBody<3>& ball = world.bodies.add(make_soft_body_model(make_sphere(0.5f, 3), settings), {0, 3, 0});
  const double whole = double{ball.model().mass()};
  std::size_t vanished = 0;
  for (int i = 0; i < 240; ++i) {
    run(world, 1);
    for (const BrokenSoftBody& broken : world.bodies.poll_broken()) {
      vanished += broken.vanished;
      EXPECT_EQ(broken.particles_before.size(), broken.pieces.size() + 1);
    }
  }
  EXPECT_GT(vanished, 0u);
  double sum = 0;
  for (std::size_t b = 0; b < world.bodies.size(); ++b) {
    sum += double{world.bodies[b].model().mass()};
    EXPECT_EQ(unmet_sides(world.bodies[b].model().mesh()), 0u);
    for (const Vector3f& x : world.bodies[b].positions()) EXPECT_TRUE(x.allFinite());
  }
  EXPECT_EQ(&world.bodies[0], &ball);
  EXPECT_LT(sum, whole);
}

/// Its support is cut off, far from what stays of the lower one.
TEST(BulletFracture, WhatSleepsOnAPieceThatVanishesFalls) {
  ContactWorld world;
  world.add(std::make_unique<btBoxShape>(btVector3(10, 0.5f, 10)), 0, {0, -0.5f, 0});
  world.bodies.let_sleep(SleepSettings{});
  SoftBodySettings firm{.cell_size = 0.1f, .half_width = 2, .alpha = 0.9f, .damping = 0.2f};
  SoftBodySettings crumbs = firm;
  crumbs.fracture = Fracture{.least_cells = 40};
  SoftBody<3>& slab =
      world.bodies.add(make_soft_body_model(make_box({1.6f, 0.2f, 0.2f}, 0.1f), crumbs), {0, 0.1f, 0});
  SoftBody<3>& box =
      world.bodies.add(make_soft_body_model(make_box({0.2f, 0.2f, 0.2f}, 0.1f), firm), {-0.65f, 0.31f, 0});
  for (int i = 0; i < 1200 && !(slab.asleep() && box.asleep()); ++i) run(world, 1);
  ASSERT_TRUE(slab.asleep() && box.asleep());
  const float before = box.centre_of_mass().y();
  EXPECT_TRUE(world.bodies.cut(slab, Cut::plane({-0.399f, 0, 0}, {1, 0, 0})).empty());
  EXPECT_EQ(slab.model().lattice().cells.size(), 48u);
  EXPECT_FALSE(box.asleep());
  run(world, 60);
  EXPECT_LT(box.centre_of_mass().y(), before - 0.1f);
}

TEST(BulletFracture, WhatIsRemovedIsNotNamed) {
  ContactWorld world({0, 0, 0});
  SoftBodySettings settings{.cell_size = 0.1f, .half_width = 1};
  SoftBody<3>& bar =
      world.bodies.add(make_soft_body_model(make_box({1, 0.1f, 0.1f}, 0.1f), settings), {0, 2, 0});
  const auto first = world.bodies.cut(bar, Cut::plane({0.101f, 2, 0}, {1, 0, 0}));
  const auto second = world.bodies.cut(*first[0], Cut::plane({0.301f, 2, 0}, {1, 0, 0}));
  ASSERT_EQ(second.size(), 1u);
  world.bodies.remove(*first[0]);
  const auto broken = world.bodies.poll_broken();
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].body, &bar);
  EXPECT_TRUE(broken[0].pieces.empty());
  EXPECT_EQ(world.bodies.size(), 2u);
  EXPECT_THROW(world.bodies.cut(*first[0], Cut::plane({0, 0, 0}, {1, 0, 0})), std::invalid_argument);
}

TEST(BulletFracture, ACopyBringsAWholeBodyBack) {
  ContactWorld world({0, -9.81f, 0});
  world.add(std::make_unique<btBoxShape>(btVector3(10, 0.5f, 10)), 0, {0, -0.5f, 0});
  SoftBody<3>& ball = world.bodies.add(brittle_ball(0.05f), {0, 2, 0});
  const SoftBody<3> saved = ball;
  run(world, 120);
  ASSERT_GT(world.bodies.size(), 1u);
  const std::size_t pieces = world.bodies.size();
  while (world.bodies.size() > 1) world.bodies.remove(world.bodies[world.bodies.size() - 1]);
  ball = saved;
  run(world, 120);
  EXPECT_EQ(world.bodies.size(), pieces);
}

TEST(BulletFracture, BodiesThatTouchWithSpheresDoNotBreak) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  BulletSoftBodies bodies(world, ContactMethod::kSpheres);
  EXPECT_THROW(bodies.add(brittle_ball(0.1f), {0, 0, 0}), std::invalid_argument);
  const SoftBody<3>& whole =
      bodies.add(make_soft_body_model(make_sphere(0.5f, 2), {.cell_size = 0.2f}), {0, 0, 0});
  EXPECT_THROW(bodies.cut(whole, Cut::plane({0, 0, 0}, {1, 0, 0})), std::invalid_argument);
}

TEST(FractureSettings, OutOfRangeAreRefused) {
  SoftBodySettings settings{.cell_size = 0.1f};
  settings.fracture = Fracture{.stretch = 0.0f};
  EXPECT_THROW(validate(settings), std::runtime_error);
  settings.fracture = Fracture{.turn = 4.0f};
  EXPECT_THROW(validate(settings), std::runtime_error);
  settings.fracture = Fracture{};
  EXPECT_NO_THROW(validate(settings));
  settings.fracture = Fracture{.least_cells = 0};
  try {
    validate(settings);
    FAIL() << "pieces of 0 cells and more stay";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "a soft body's fracture.least_cells is 0; it must be a number of cells, 1 or above");
  }
  settings.fracture = Fracture{.least_cells = ~0u};
  EXPECT_NO_THROW(validate(settings));
  EXPECT_THROW(
      make_soft_body_model(make_sphere(0.5f, 2), {.cell_size = 0.2f}, [](const Vector3f&) { return -1.0f; }),
      std::runtime_error);
  const std::vector<Eigen::Vector2i> cells{{0, 0}, {1, 0}};
  EXPECT_NO_THROW(make_soft_body_model(lattice_from_cells(cells, 0.1f), settings));
  settings.fracture = Fracture{.stretch = -1.0f};
  EXPECT_THROW(make_soft_body_model(lattice_from_cells(cells, 0.1f), settings), std::runtime_error);
}

}  // namespace
}  // namespace softcell::ppu
