// Soft bodies in a Bullet world, stepped by SPEs: against the PPU's solver, and against what must be true
// whoever steps them.

#include "softcell/spe_bodies/spe_solver.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "free_flight.h"
#include "ppu/bodies/break_body.h"
#include "ppu/plans/match_plan.h"
#include "ppu/plans/tile_plan.h"
#include "ppu/spe_bodies/match_bodies.h"
#include "ppu/spe_bodies/tiled_memory.h"
#include "soft_body_scenes.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/state_hash.h"
#include "spu_kernels/checked_runs.h"
#include "spu_kernels/kernel_image.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

SoftBodySettings rubber() {
  return {.cell_size = 0.2f, .half_width = 2, .density = 200, .alpha = 0.5f, .damping = 0.1f};
}

/// A Bullet world whose soft bodies are stepped by SPEs.
struct SpeWorld {
  /// The kernels are instrumented when there are findings to report to.
  explicit SpeWorld(const ls_sim::SpeOptions& options = {.spes = 2})
      : match(softcell::test::kernel_image("match", options.findings != nullptr)),
        match_tiles(softcell::test::kernel_image("match_tiles", options.findings != nullptr)),
        jobs(memory, options, job_loop),
        solver(memory, jobs, {match, match_tiles}),
        soft(bullet.world(), solver) {}

  void add_floor() { bullet.add_box({20, 1, 20}, 0, {0, -0.5f, 0}, 0.6f); }
  void run(int frames) {
    for (int i = 0; i < frames; ++i) bullet.step(kFrame, 2);
  }
  std::uint64_t jobs_done() const {
    std::uint64_t sum = 0;
    for (const ls_sim::SpeStatistics& spe : jobs.statistics()) sum += spe.jobs;
    return sum;
  }

  dma::AddressSpace memory;
  ls_sim::KernelImage job_loop = softcell::test::kernel_image("job_loop"), match, match_tiles;
  JobSystem jobs;
  SpeSolver<3> solver;
  BulletWorld bullet;
  BulletSoftBodies soft;
};

/// Bent, and moving in a way that no rigid body does.
void bend(SoftBody<3>& body) {
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    const Vector3f x = body.position(i);
    body.set_particle(i, x + Vector3f(0.3f * x.y() * x.y(), 0, 0), {x.z(), 0.5f * x.x() * x.x(), -x.y()});
  }
  body.translate({0, 0, 0});  // so that couplings notice
}

TEST(SpeSolver, AgreesWithThePpuInOneStepFromTheSameState) {
  const auto model = block_model({5, 4, 3}, rubber());
  SpeWorld world;
  SoftBody<3> on_spe(model), on_ppu(model);
  bend(on_spe);
  bend(on_ppu);
  SoftBody<3>* const one[] = {&on_spe};
  PpuSolver<3> ppu;
  SoftBody<3>* const other[] = {&on_ppu};
  const float size = 0.2f * 5;
  constexpr float kStep = 1.0f / 120;
  for (int step = 0; step < 3; ++step) {
    world.solver.kick(one, kStep);
    ppu.kick(other, kStep);
    world.solver.finish();
    ppu.finish();
    for (std::size_t i = 0; i < model->particles(); ++i) {
      // A velocity is the pull by alpha / h times the distance to the goal.
      const float goal_error =
          (on_spe.velocities()[i] - on_ppu.velocities()[i]).norm() * kStep / rubber().alpha;
      ASSERT_LE(goal_error, 1e-5f * size) << "step " << step << ", particle " << i;
    }
    for (std::size_t i = 0; i < model->particles(); ++i) {
      on_spe.set_velocity(i, on_ppu.velocities()[i]);  // the same state again
    }
  }
}

TEST(SpeSolver, BodiesInFlightKeepTheirMomenta) {
  for (const Eigen::Vector3i& cells :
       {Eigen::Vector3i(5, 4, 3), Eigen::Vector3i(12, 12, 12)}) {  // the second in tiles
    if (kSlowBuild && cells.x() > 5) continue;
    SpeWorld world;
    SoftBody<3> body(block_model(cells, rubber()), {3, 2, 1});
    test::throw_body(body);
    test::expect_momenta_stay(world.solver, body);
    EXPECT_EQ(world.solver.bodies_on_ppu(), 0u);
  }
}

std::uint64_t hash_of_a_run(const ls_sim::SpeOptions& options, bool ahead) {
  SpeWorld world(options);
  world.add_floor();
  const auto block = block_model({3, 3, 3}, rubber()), bar = block_model({6, 1, 2}, rubber());
  const SoftBody<3>* const bodies[] = {&world.soft.add(block, {0, 1, 0}), &world.soft.add(bar, {0.5f, 2, 0}),
                                       &world.soft.add(block, {0.2f, 3, 0})};
  for (int frame = 0; frame < 60; ++frame) {
    world.bullet.step(kFrame, 2);
    if (frame == 30) world.soft[0].add_velocity({1, 2, 0});
    if (ahead) world.soft.begin_ahead(kFrame / 2);
  }
  return state_hash(bodies);
}

TEST(SpeSolver, TheCheckedKernelFindsNothingAndGivesTheSameBytes) {
  const std::uint64_t expected = hash_of_a_run({.spes = 1}, true);
  softcell::test::expect_no_findings(
      [&](const ls_sim::SpeOptions& options) { EXPECT_EQ(hash_of_a_run(options, true), expected); });
}

TEST(SpeSolver, ABodyThatFillsALocalStoreIsTooLargeForTheCheckedKernel) {
  const auto model = block_model({9, 9, 9}, rubber());
  EXPECT_NO_THROW(MatchPlan(model->lattice(), *model->plan()));
  EXPECT_THROW(MatchPlan(model->lattice(), *model->plan(), spu::kMatchCheckedArenaBytes), BodyTooLarge);
}

TEST(SpeSolver, GivesTheSameBytesOnAnySpesUnderEverySchedule) {
  const std::uint64_t expected = hash_of_a_run({.spes = 1}, true);
  for (const char* schedule : {"eager", "lazy", "random:1"})
    for (const int spes : {1, 3, 6})
      EXPECT_EQ(hash_of_a_run({.spes = spes, .schedule = dma::parse_schedule(schedule)}, true), expected)
          << schedule << ", " << spes << " SPEs";
}

TEST(SpeSolver, WorkBegunAheadChangesNothing) {
  SpeWorld plain, early;
  const auto model = block_model({3, 3, 3}, rubber());
  for (SpeWorld* const world : {&plain, &early}) {
    world->add_floor();
    world->soft.add(model, {0, 0.5f, 0});
  }
  for (int frame = 0; frame < 90; ++frame) {
    plain.bullet.step(kFrame, 2);
    early.bullet.step(kFrame, 2);
    early.soft.begin_ahead(kFrame / 2);
  }
  EXPECT_EQ(state_hash(plain.soft[0]), state_hash(early.soft[0]));
}

TEST(SpeSolver, WorkBegunAheadIsDoneAgainWhenABodyIsPushedOrTheStepIsAnother) {
  SpeWorld world;
  SoftBody<3>& body = world.soft.add(block_model({2, 2, 2}, rubber()), {0, 0, 0});
  world.bullet.set_gravity(Vector3f::Zero());
  world.soft.begin_ahead(kFrame);
  body.add_velocity({1, 0, 0});
  world.bullet.step(kFrame, 1);
  EXPECT_NEAR(body.velocities()[0].x(), 1, 1e-5);
  world.soft.begin_ahead(kFrame);
  world.bullet.step(kFrame / 4, 1);
  EXPECT_NEAR(body.velocities()[0].x(), 1, 1e-5);
  EXPECT_NEAR(body.centre_of_mass().x(), kFrame + kFrame / 4, 1e-4);
}

TEST(SpeSolver, AWorldWithoutSoftBodiesStepsToo) {
  SpeWorld world;
  world.add_floor();
  world.soft.begin_ahead(kFrame / 2);
  world.run(2);
  EXPECT_EQ(world.jobs_done(), 0u);
}

TEST(SpeSolver, RestsOnAFloorInShape) {
  SpeWorld world;
  world.add_floor();
  SoftBody<3>& body = world.soft.add(block_model({4, 4, 4}, rubber()), {0, 0.3f, 0});
  world.run(600);
  EXPECT_LT(fastest(body), 0.02f);
  EXPECT_LT(body.deformation(), 0.05f * 0.8f);
  EXPECT_GT(body.bounds().low.y(), -0.01f * body.model().settings().cell_size);
}

TEST(SpeSolver, BodiesComeAndGoAndTheOthersKeepTheirShape) {
  SpeWorld world;
  world.bullet.set_gravity(Vector3f::Zero());
  const auto block = block_model({3, 2, 2}, rubber()), bar = block_model({5, 1, 1}, rubber());
  SoftBody<3>& first = world.soft.add(block, {0, 0, 0});
  SoftBody<3>& second = world.soft.add(bar, {0, 3, 0});
  world.run(2);
  SoftBody<3>& third = world.soft.add(block, {0, 6, 0});
  first.move_without_force(Eigen::Quaternionf(Eigen::AngleAxisf(2.5f, Vector3f(1, 2, 3).normalized())),
                           {4, 0, 0});
  world.run(2);
  world.soft.begin_ahead(kFrame / 2);
  world.soft.remove(second);
  world.run(2);
  EXPECT_LT(fastest(first), 1e-3f);  // a teleported body has no reason to move
  EXPECT_LT(first.deformation(), 1e-4f);
  EXPECT_LT(fastest(third), 1e-3f);
}

/// More particles than a local store holds.
std::shared_ptr<const SoftBodyModel<3>> large_model() { return block_model({11, 10, 10}, rubber()); }

/// What no local store holds, not even in tiles: a row and those that it needs are too high.
std::shared_ptr<const SoftBodyModel<3>> huge_model() {
  SoftBodySettings wide = rubber();
  wide.half_width = 8;
  wide.contacts = false;
  return block_model({2, 12, 256}, wide);
}

TEST(SpeSolver, ABodyTooLargeForALocalStoreIsSteppedInTiles) {
  const auto large = large_model(), small = block_model({2, 2, 2}, rubber());
  ASSERT_THROW(MatchPlan(large->lattice(), *large->plan()), BodyTooLarge);
  SpeWorld world;
  SoftBody<3> on_spe(large), other(small), on_ppu(large);
  for (SoftBody<3>* const body : {&on_spe, &other, &on_ppu}) bend(*body);
  SoftBody<3>* const both[] = {&on_spe, &other};
  PpuSolver<3> ppu;
  SoftBody<3>* const one[] = {&on_ppu};
  constexpr float kStep = 1.0f / 120, kSize = 0.2f * 11;
  for (int step = 0; step < 3; ++step) {
    const std::uint64_t before = world.jobs_done();
    world.solver.kick(both, kStep);
    ppu.kick(one, kStep);
    world.solver.finish();
    ppu.finish();
    EXPECT_GE(world.jobs_done(), before + 1 + 4);  // the small body's, and all passes
    for (std::size_t i = 0; i < large->particles(); ++i) {
      const float goal_error =
          (on_spe.velocities()[i] - on_ppu.velocities()[i]).norm() * kStep / rubber().alpha;
      ASSERT_LE(goal_error, 1e-5f * kSize) << "step " << step << ", particle " << i;
    }
    for (std::size_t i = 0; i < large->particles(); ++i) on_spe.set_velocity(i, on_ppu.velocities()[i]);
  }
}

/// Regions at a round surface have sums of their own, so fewer rows fit than of a block that is as high.
TEST(SpeSolver, LargeBallsAndCubesAreSteppedInTilesToo) {
  std::vector<std::shared_ptr<const SoftBodyModel<3>>> models{block_model({25, 25, 25}, rubber())};
  for (const float radius : {2.0f, 3.16f})
    models.push_back(make_soft_body_model(make_sphere(radius, 2), rubber()));
  for (const auto& model : models) {
    SpeWorld world;
    SoftBody<3> on_spe(model), on_ppu(model);
    bend(on_spe), bend(on_ppu);
    SoftBody<3>* const one[] = {&on_spe};
    SoftBody<3>* const other[] = {&on_ppu};
    PpuSolver<3> ppu;
    constexpr float kStep = 1.0f / 120, kSize = 2 * 3.16f;
    world.solver.kick(one, kStep);
    EXPECT_EQ(world.solver.bodies_on_ppu(), 0u) << model->particles();
    ppu.kick(other, kStep);
    world.solver.finish();
    ppu.finish();
    for (std::size_t i = 0; i < model->particles(); ++i)
      ASSERT_LE((on_spe.velocities()[i] - on_ppu.velocities()[i]).norm() * kStep / rubber().alpha,
                1e-5f * kSize)
          << model->particles() << ", particle " << i;
  }
}

TEST(SpeSolver, ABodyTooHighForTilesIsSteppedByThePpu) {
  const auto huge = huge_model();
  ASSERT_THROW(TilePlan(huge->lattice(), *huge->plan()), BodyTooLarge);
  SpeWorld world;
  world.bullet.set_gravity(Vector3f::Zero());
  SoftBody<3>& body = world.soft.add(huge, {0, 0, 0});
  SoftBody<3>& small = world.soft.add(block_model({2, 2, 2}, rubber()), {9, 0, 0});
  body.add_particle_velocity(0, {1, 0, 0});
  bend(small);
  const float before_small = small.deformation();
  world.run(1);
  EXPECT_LT(body.velocities()[0].x(), 0.9f);
  EXPECT_LT(small.deformation(), before_small);
}

/// A large body and a small one, pushed, moved and left alone, in tiles where they do not fit.
std::uint64_t hash_of_a_large_run(const ls_sim::SpeOptions& options) {
  SpeWorld world(options);
  world.bullet.set_gravity({0, -2, 0});
  SoftBodySettings settings = rubber();
  settings.contacts = false;
  SoftBody<3>& large = world.soft.add(block_model({12, 11, 9}, settings), {0, 0, 0});
  SoftBody<3>& small = world.soft.add(block_model({2, 3, 2}, settings), {0, 5, 0});
  bend(large);
  const SoftBody<3>* const bodies[] = {&large, &small};
  world.run(4);
  large.add_velocity({0, 1, 0});
  world.soft.begin_ahead(kFrame / 2);
  world.run(2);
  world.soft.add(block_model({2, 2, 2}, settings), {5, 0, 0});  // memory is laid out anew
  world.run(2);
  large.move_without_force(Eigen::Quaternionf(Eigen::AngleAxisf(2, Vector3f::UnitX())), {1, 0, 0});
  world.run(2);
  return state_hash(bodies);
}

TEST(SpeSolver, ALargeBodyGivesTheSameBytesOnAnySpesUnderEverySchedule) {
  const std::uint64_t expected = hash_of_a_large_run({.spes = 1});
  for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
    for (int spes = 1; spes <= 6; ++spes) {
      std::uint64_t hash = 0;
      ASSERT_NO_THROW(hash = hash_of_a_large_run({.spes = spes, .schedule = dma::parse_schedule(schedule)}))
          << schedule << ", " << spes << " SPEs" << softcell::test::kDependsOnTheSchedule;
      EXPECT_EQ(hash, expected) << schedule << ", " << spes << " SPEs"
                                << softcell::test::kDependsOnTheSchedule;
    }
  }
}

TEST(SpeSolver, TheCheckedKernelFindsNothingInALargeBodyAndGivesTheSameBytes) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run MatchTiles.CheckedKernelsFindNothing";
  const std::uint64_t expected = hash_of_a_large_run({.spes = 1});
  softcell::test::expect_no_findings(
      [&](const ls_sim::SpeOptions& options) { EXPECT_EQ(hash_of_a_large_run(options), expected); });
}

/// Where a rotation is sought from shows in its last bits.
TEST(SpeSolver, ABodyKeepsItsRotationsWhenOthersComeAndGo) {
  for (const auto& model : {block_model({3, 3, 3}, rubber()), large_model()}) {
    const auto hash_of_a_run = [&](bool others) {
      SpeWorld world;
      world.bullet.set_gravity(Vector3f::Zero());
      SoftBody<3>& body = world.soft.add(model, {0, 0, 0});
      bend(body);
      world.run(2);
      SoftBody<3>* const other = others ? &world.soft.add(model, {0, 9, 0}) : nullptr;
      world.run(2);
      if (other != nullptr) world.soft.remove(*other);
      world.run(2);
      return state_hash(body);
    };
    EXPECT_EQ(hash_of_a_run(true), hash_of_a_run(false)) << model->particles();
  }
}

/// Sets each region's rotation to a number of its own.
void number(RegionRotations rotations) {
  rotations.cold = 0;
  for (const std::uint32_t place : rotations.place_of)
    rotations.rotations[place / 4].w[place % 4] = static_cast<float>(place + 1);
}
float number_of(const RegionRotations& rotations, std::size_t particle) {
  const std::uint32_t place = rotations.place_of[particle];
  return rotations.rotations[place / 4].w[place % 4];
}

TEST(SpeSolver, RegionsOfAPieceBeginWithTheRotationsThatTheyHadInTheBody) {
  const auto large = block_model({12, 11, 10}, rubber());
  const SoftBody<3> body(large);
  const auto cut = faces_across(body, Cut::plane({-0.1f, 0, 0}, {1, 0, 0}));
  const std::vector<BodyPiece<3>> pieces = pieces_of(body, cut);
  ASSERT_EQ(pieces.size(), 2u);
  const SoftBodyModel<3>& small = pieces[1].body.model();
  ASSERT_THROW(MatchPlan(large->lattice(), *large->plan()), BodyTooLarge);
  const MatchPlan whole_plan(small.lattice(), *small.plan());
  const TilePlan tiles_of_body(large->lattice(), *large->plan()), tiles(small.lattice(), *small.plan());
  dma::AddressSpace memory;
  TiledMemory of_body(memory, tiles_of_body), tiled(memory, tiles);
  MatchBodies<3> whole(memory, whole_plan, 2);
  const auto known = [&] { return of_body.region_rotations(tiles_of_body, large->plan()->sums()); };
  const auto in_tiles = [&] { return tiled.region_rotations(tiles, small.plan()->sums()); };
  EXPECT_NE(known().cold, 0u);
  number(known());
  in_tiles().take_from(known(), pieces[1].particle_of);
  whole.region_rotations(1).take_from(known(), pieces[1].particle_of);
  EXPECT_EQ(in_tiles().cold, 0u);
  EXPECT_EQ(whole.region_rotations(1).cold, 0u);
  EXPECT_NE(whole.region_rotations(0).cold, 0u);
  for (std::size_t i = 0; i < small.particles(); ++i) {
    const float expected = number_of(known(), pieces[1].particle_of[i]);
    ASSERT_EQ(number_of(in_tiles(), i), expected) << i;
    ASSERT_EQ(number_of(whole.region_rotations(1), i), expected) << i;
  }
}

TEST(SpeSolver, MemoryThatWasPreparedIsNotLaidOutAgain) {
  for (const auto& model : {block_model({3, 3, 3}, rubber()), large_model()}) {
    SpeWorld world;
    world.run(1);
    const auto free = [&] { return world.memory.free_bytes(dma::Memory::kMain); };
    const std::uint64_t before = free();
    world.solver.prepare(model);
    const std::uint64_t taken = before - free();
    EXPECT_GT(taken, 50 * model->particles());
    SoftBody<3>& body = world.soft.add(model, {0, 0, 0});
    world.run(1);
    EXPECT_LT(before - free(), taken + 50 * model->particles()) << "but for a chain";
    world.soft.add(model, {0, 9, 0});  // nothing was prepared for it
    world.soft.remove(body);
    EXPECT_NO_THROW(world.run(1));
    // What nobody has bodies of goes.
    world.solver.prepare(block_model({4, 4, 4}, rubber()));
    world.soft.remove(world.soft[0]);
    world.run(1);
    EXPECT_LE(before - free(), std::uint64_t{4096});
  }
}

TEST(SpeSolver, ABodyForgetsItsRotationsWhenItIsTeleported) {
  for (const auto& model : {block_model({3, 3, 3}, rubber()), large_model()}) {
    SpeWorld world, anew;
    for (SpeWorld* const each : {&world, &anew}) each->bullet.set_gravity(Vector3f::Zero());
    SoftBody<3>& body = world.soft.add(model, {0, 0, 0});
    bend(body);
    world.run(2);
    body.move_without_force(Eigen::Quaternionf(Eigen::AngleAxisf(0.2f, Vector3f(1, 2, 3).normalized())),
                            {4, 0, 0});
    SoftBody<3>& fresh = anew.soft.add(model, {0, 0, 0});
    fresh = body;
    world.run(1);
    anew.run(1);
    EXPECT_EQ(state_hash(body), state_hash(fresh)) << model->particles();
  }
}

TEST(SpeSolver, ALargeBodyStaysWithTheSpesWhenThereIsNoRoomForAnother) {
  SpeWorld world;
  world.bullet.set_gravity(Vector3f::Zero());
  const auto model = large_model();
  world.soft.add(model, {0, 0, 0});
  world.run(1);
  std::vector<dma::Buffer<std::byte>> rest;
  for (std::size_t bytes = 128 << 20; bytes >= 1024; bytes /= 2) {
    try {
      for (;;) rest.emplace_back(world.memory, "rest", bytes);
    } catch (const std::runtime_error&) {  // then less of it
    }
  }
  SoftBody<3>& second = world.soft.add(model, {0, 9, 0});
  EXPECT_THROW(world.run(1), std::runtime_error);
  world.soft.remove(second);
  rest.clear();
  const std::uint64_t before = world.jobs_done();
  world.run(1);
  EXPECT_GT(world.jobs_done(), before);
}

TEST(SpeSolver, ANanThatThePpuFindsLeavesNoJobUnderWay) {
  SpeWorld world;
  SoftBody<3>& huge = world.soft.add(huge_model(), {0, 0, 0});
  world.soft.add(large_model(), {0, 30, 0});
  world.run(1);
  huge.set_particle(0, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 0, 0});
  huge.translate({0, 0, 0});
  EXPECT_THROW(world.run(1), std::runtime_error);
  const std::uint64_t before = world.jobs_done();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(world.jobs_done(), before) << "no job is under way";
  huge.reset({0, 0, 0});
  world.run(1);  // with the same bodies, whose chain is used again
  EXPECT_GT(world.jobs_done(), before);
}

TEST(SpeSolver, ANanInALargeBodyIsReported) {
  SpeWorld world;
  SoftBody<3>& body = world.soft.add(large_model(), {0, 0, 0});
  world.run(1);
  body.set_particle(700, {0, std::numeric_limits<float>::quiet_NaN(), 0}, {0, 0, 0});
  body.translate({0, 0, 0});
  EXPECT_THROW(world.run(1), std::runtime_error);
}

TEST(SpeSolver, ANanIsReported) {
  SpeWorld world;
  SoftBody<3>& body = world.soft.add(block_model({2, 2, 2}, rubber()), {0, 0, 0});
  world.run(1);
  body.set_particle(0, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 0, 0});
  body.translate({0, 0, 0});
  EXPECT_THROW(world.run(1), std::runtime_error);
}

TEST(SpeSolver, SleepingBodiesHaveNoJob) {
  SpeWorld world;
  world.add_floor();
  world.soft.let_sleep(SleepSettings{});
  const auto model = block_model({3, 3, 3}, rubber());
  SoftBody<3>& low = world.soft.add(model, {0, 0.1f, 0});
  SoftBody<3>& high = world.soft.add(model, {3, 0.2f, 0});
  world.run(400);
  ASSERT_TRUE(low.asleep() && high.asleep());
  const std::uint64_t before = world.jobs_done();
  const std::uint64_t state = state_hash(low);
  world.run(30);
  EXPECT_EQ(world.jobs_done(), before);
  EXPECT_EQ(state_hash(low), state);

  high.translate({-3, 1, 0});  // what is changed wakes
  world.run(2);
  EXPECT_FALSE(high.asleep());
  EXPECT_TRUE(low.asleep());
  EXPECT_GT(world.jobs_done(), before);
  world.run(40);  // and so does what it falls upon
  EXPECT_FALSE(low.asleep());
  EXPECT_NE(state_hash(low), state);
}

TEST(SpeSolver, ASleepingBodyWakesWhenGravityTurns) {
  SpeWorld world;
  world.add_floor();
  world.soft.let_sleep(SleepSettings{});
  SoftBody<3>& body = world.soft.add(block_model({3, 3, 3}, rubber()), {0, 0.1f, 0});
  world.run(400);
  ASSERT_TRUE(body.asleep());
  world.bullet.set_gravity({9.81f, -2, 0});
  world.run(10);
  EXPECT_FALSE(body.asleep());
  EXPECT_GT(fastest(body), 0.1f);
}

/// A car's worth of particles, plastic.
SoftBodySettings tin() {
  SoftBodySettings settings = rubber();
  settings.plasticity = Plasticity{.yield = 0.03f, .creep = 30};
  return settings;
}

TEST(SpeSolver, APlasticBodyInFlightKeepsItsMomenta) {
  SpeWorld world;
  SoftBody<3> body(block_model({7, 5, 9}, tin()));
  bend(body);
  test::throw_body(body);
  test::expect_momenta_stay(world.solver, body);
  EXPECT_TRUE(body.has_own_rest()) << "it has yielded";
  EXPECT_EQ(world.solver.bodies_on_ppu(), 0u);
}

// Plastic bodies: whole (480 particles), in tiles (1,452), and elastic ones between them, thrown at the floor.
std::uint64_t hash_of_a_crash(const ls_sim::SpeOptions& options) {
  SpeWorld world(options);
  world.add_floor();
  const auto small = block_model({7, 5, 9}, tin()), large = block_model({10, 10, 11}, tin());
  const auto elastic = block_model({3, 3, 3}, rubber());
  std::vector<SoftBody<3>*> bodies;
  for (int i = 0; i < 4; ++i) {
    const float x = 4.0f * static_cast<float>(i);
    const auto& model = i == 1 ? large : i == 2 ? elastic : small;
    bodies.push_back(&world.soft.add(model, {x, 0.3f, 0}));
    bodies.back()->add_velocity({0, -8, 0});
    bodies.back()->add_angular_velocity({0.5f, 0, 1});
  }
  world.run(40);
  EXPECT_EQ(world.solver.bodies_on_ppu(), 0u);
  EXPECT_TRUE(bodies[0]->has_own_rest());
  EXPECT_TRUE(bodies[1]->has_own_rest());
  EXPECT_FALSE(bodies[2]->has_own_rest());
  EXPECT_NE(state_hash(*bodies[0]), state_hash(*bodies[3]));
  std::uint64_t hash = 0;
  for (const SoftBody<3>* body : bodies) hash = state_hash(*body, hash);
  return hash;
}

TEST(SpeSolver, PlasticBodiesAreTheSameForAnyNumberOfSpesAndSchedule) {
  const std::uint64_t hash = hash_of_a_crash({.spes = 1});
  for (const char* schedule : {"eager", "lazy", "random:1"})
    for (const int spes : {2, 6})
      EXPECT_EQ(hash_of_a_crash({.spes = spes, .schedule = dma::parse_schedule(schedule)}), hash)
          << schedule << ", " << spes << " SPEs";
}

TEST(SpeSolver, StepsAPlasticBodyAsThePpuDoes) {
  // Whole, and in tiles.
  for (const Eigen::Vector3i& cells : {Eigen::Vector3i(7, 5, 9), Eigen::Vector3i(10, 10, 11)}) {
    const auto model = block_model(cells, tin());
    SpeWorld world;
    SoftBody<3> on_spe(model), on_ppu(model);
    PpuSolver<3> ppu;
    SoftBody<3>* const one[] = {&on_spe};
    SoftBody<3>* const other[] = {&on_ppu};
    bend(on_spe), bend(on_ppu);
    constexpr float kStep = 1.0f / 120;
    const auto advance = [&](SoftBody<3>& body) {
      for (std::size_t i = 0; i < body.positions().size(); ++i)
        body.set_particle(i, body.position(i) + kStep * body.velocities()[i], body.velocities()[i]);
    };
    for (int i = 0; i < 30; ++i) {
      world.solver.kick(one, kStep);
      world.solver.finish();
      ppu.kick(other, kStep);
      ppu.finish();
      advance(on_spe), advance(on_ppu);
    }
    ASSERT_TRUE(on_spe.has_own_rest());
    const auto rest = on_spe.rest_positions(), rest_of_ppu = on_ppu.rest_positions();
    float moved = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      ASSERT_LT((on_spe.position(i) - on_ppu.position(i)).norm(), 2e-3f * 0.2f) << "particle " << i;
      ASSERT_LT((rest[i] - rest_of_ppu[i]).norm(), 2e-3f * 0.2f) << "particle " << i;
      moved = std::max(moved, (rest[i] - model->lattice().rest_position(i)).norm());
    }
    EXPECT_GT(moved, 0.1f * 0.2f);
    // Straightened: the SPEs' plan has the model's rest shape again.
    on_spe.reset_deformation();
    world.solver.forget(on_spe);
    const Vector3f before = on_spe.velocities()[0];
    world.solver.kick(one, kStep);
    world.solver.finish();
    EXPECT_LT((on_spe.velocities()[0] - before).norm(), 1e-3f * before.norm() + 1e-3f);
  }
}

TEST(SpeSolver, ABodyThatBecomesPlasticGetsAPlanOfItsOwn) {
  const auto model = block_model({5, 4, 3}, rubber());
  SpeWorld world;
  SoftBody<3> a(model), b(model), reference(model);
  SoftBody<3>* const both[] = {&a, &b};
  SoftBody<3>* const one[] = {&reference};
  constexpr float kStep = 1.0f / 120;
  bend(a), bend(b), bend(reference);
  a.set_material(tin());
  SpeWorld other;
  for (int i = 0; i < 20; ++i) {
    world.solver.kick(both, kStep);
    world.solver.finish();
    other.solver.kick(one, kStep);
    other.solver.finish();
    for (SoftBody<3>* const body : {&a, &b, &reference})
      for (std::size_t p = 0; p < body->positions().size(); ++p)
        body->set_particle(p, body->position(p) + kStep * body->velocities()[p], body->velocities()[p]);
  }
  EXPECT_TRUE(a.has_own_rest());
  EXPECT_EQ(state_hash(b), state_hash(reference)) << "another body of the model is as it was";
  a.set_material(rubber());  // elastic again: it keeps its dents
  world.solver.kick(both, kStep);
  world.solver.finish();
  EXPECT_TRUE(a.has_own_rest());
}

}  // namespace
}  // namespace softcell::ppu
