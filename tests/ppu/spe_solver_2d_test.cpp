// A Box2D world whose soft bodies are matched on SPEs, beside one that does it itself.

#include "softcell/spe_bodies/spe_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>
#include <thread>
#include <vector>

#include "free_flight.h"
#include "lattices_2d.h"
#include "ppu/plans/match_plan_2d.h"
#include "soft_body_2d_scenes.h"
#include "softcell/soft_bodies/state_hash.h"
#include "spu_kernels/kernel_image.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;

SoftBodySettings rubber_sheet() {
  return {.cell_size = 0.1f, .half_width = 2, .density = 5, .alpha = 0.5f, .damping = 0.1f};
}

std::shared_ptr<const SoftBodyModel<2>> man() { return make_soft_body_model(test::man132(), rubber_sheet()); }

/// Bent, and moving in a way that no rigid body does.
void bend(SoftBody<2>& body) {
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    const Vector2f x = body.position(i);
    body.set_particle(i, x + Vector2f(0.3f * x.y() * x.y(), 0), {0.5f * x.x() * x.x(), -x.y()});
  }
  body.translate({0, 0});  // so that couplings notice
}

/// SPEs and what matches on them.
struct Spes {
  explicit Spes(const ls_sim::SpeOptions& options = {.spes = 2}) : jobs(memory, options, job_loop) {}

  std::uint64_t jobs_done() const {
    std::uint64_t sum = 0;
    for (const ls_sim::SpeStatistics& spe : jobs.statistics()) sum += spe.jobs;
    return sum;
  }

  dma::AddressSpace memory;
  ls_sim::KernelImage job_loop = softcell::test::kernel_image("job_loop"),
                      match_2d = softcell::test::kernel_image("match_2d");
  JobSystem jobs;
  SpeSolver<2> solver{memory, jobs, {match_2d}};
};

/// Two men and a block fall on a floor and each other.
struct Pile {
  explicit Pile(SoftBodySolver<2>& solver) : soft(box2d, solver) {
    b2PolygonShape floor;
    floor.SetAsBox(20, 1, {0, -1}, 0);
    const b2BodyDef fixed;
    box2d.CreateBody(&fixed)->CreateFixture(&floor, 0);
    const auto model = man();
    soft.add(model, {0, 0.1f});
    soft.add(rectangle_model({5, 4}, rubber_sheet()), {0.6f, 2.2f});
    soft.add(model, {0.3f, 3});
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) soft.step(1.0f / 120);
  }
  /// Positions and velocities of all particles.
  std::vector<Vector2f> state() const {
    std::vector<Vector2f> all;
    for (std::size_t b = 0; b < soft.size(); ++b) {
      all.insert(all.end(), soft[b].positions().begin(), soft[b].positions().end());
      all.insert(all.end(), soft[b].velocities().begin(), soft[b].velocities().end());
    }
    return all;
  }

  b2World box2d{{0, -9.81f}};
  Box2dSoftBodies soft;
};

TEST(SpeSolver2d, ABodyInFlightKeepsItsMomenta) {
  Spes spes;
  SoftBody<2> body(man(), {1, 2});
  test::throw_body(body);
  test::expect_momenta_stay(spes.solver, body);
  EXPECT_EQ(spes.solver.bodies_on_ppu(), 0u);
}

TEST(SpeSolver2d, GoesWithTheSolverOfThePpu) {
  Spes spes;
  PpuSolver<2> ppu;
  Pile here(ppu), there(spes.solver);
  // Until rounding errors have grown by contacts.
  for (const int steps : {1, 30}) {
    here.run(steps);
    there.run(steps);
    for (std::size_t b = 0; b < here.soft.size(); ++b)
      for (std::size_t i = 0; i < here.soft[b].positions().size(); ++i)
        ASSERT_LT((here.soft[b].positions()[i] - there.soft[b].positions()[i]).norm(), 1e-4f)
            << "after " << steps << ", body " << b << ", particle " << i;
  }
  EXPECT_GT(there.soft.times().wait.count(), 0);
}

TEST(SpeSolver2d, GivesTheSameBitsForAnyNumberOfSpesAndEverySchedule) {
  std::vector<Vector2f> expected;
  for (const int spes : {1, 3, 6}) {
    for (const char* schedule : {"eager", "lazy", "random:3"}) {
      Spes machine({.spes = spes, .schedule = dma::parse_schedule(schedule)});
      Pile pile(machine.solver);
      pile.run(240);
      for (std::size_t b = 0; b < pile.soft.size(); ++b) ASSERT_LT(pile.soft[b].deformation(), 1.0f);
      if (expected.empty()) expected = pile.state();
      ASSERT_EQ(pile.state(), expected) << spes << " SPEs, " << schedule;
    }
  }
}

TEST(SpeSolver2d, BodiesComeAndGo) {
  Spes spes;
  b2World world({0, -9.81f});
  Box2dSoftBodies soft(world, spes.solver);
  soft.step(0.01f);  // nobody
  SoftBody<2>& first = soft.add(man(), {0, 0});
  soft.step(0.01f);
  SoftBody<2>& second = soft.add(rectangle_model({3, 3}, rubber_sheet()), {5, 0});
  for (int i = 0; i < 50; ++i) soft.step(0.01f);
  EXPECT_NEAR(first.velocities()[0].y(), -9.81f * 0.51f, 1e-3f);
  EXPECT_NEAR(second.velocities()[0].y(), -9.81f * 0.50f, 1e-3f);
  soft.remove(first);
  soft.step(0.01f);
  EXPECT_NEAR(second.velocities()[0].y(), -9.81f * 0.51f, 1e-3f);
  soft.remove(second);
  soft.step(0.01f);
}

TEST(SpeSolver2d, ABodyThatIsNoNumberStopsTheStep) {
  Spes spes;
  b2World world({0, 0});
  Box2dSoftBodies soft(world, spes.solver);
  SoftBody<2>& body = soft.add(man(), {0, 0});
  body.set_velocity(7, {std::nanf(""), 0});
  body.add_velocity({0, 0});  // tells the coupling of the change
  EXPECT_THROW(soft.step(0.01f), std::runtime_error);
}

TEST(SpeSolver2d, ABodyTooLargeForAnSpeIsSteppedByThePpu) {
  Spes spes;
  const auto large = rectangle_model({45, 45}, rubber_sheet()), small = man();
  ASSERT_THROW(MatchPlan2d(large->lattice(), *large->plan()), BodyTooLarge);
  SoftBody<2> with_spes(large), on_ppu(large), beside(small), alone(small);
  for (SoftBody<2>* const body : {&with_spes, &on_ppu, &beside, &alone}) bend(*body);
  PpuSolver<2> ppu;
  Spes others;
  constexpr float kStep = 1.0f / 120;
  for (int step = 0; step < 3; ++step) {
    spes.solver.kick(std::vector{&with_spes, &beside}, kStep);
    ppu.kick(std::vector{&on_ppu}, kStep);
    others.solver.kick(std::vector{&alone}, kStep);
    for (SoftBodySolver<2>* const solver :
         {static_cast<SoftBodySolver<2>*>(&spes.solver), static_cast<SoftBodySolver<2>*>(&ppu),
          static_cast<SoftBodySolver<2>*>(&others.solver)})
      solver->finish();
    EXPECT_EQ(state_hash(with_spes), state_hash(on_ppu));
    EXPECT_EQ(state_hash(beside), state_hash(alone));
    EXPECT_NE(beside.velocities()[0], with_spes.velocities()[0]) << "both were stepped";
  }
  EXPECT_EQ(spes.jobs_done(), 3u) << "the small body's only";
}

TEST(SpeSolver2d, WorkBegunAheadChangesNothing) {
  const auto state_of_a_run = [](bool ahead) {
    Spes spes;
    Pile pile(spes.solver);
    for (int step = 0; step < 240; ++step) {
      pile.soft.step(1.0f / 120);
      if (step == 30) pile.soft[0].add_velocity({1, 2});
      if (step == 60) pile.soft[1].reset({0.6f, 3});
      if (ahead) pile.soft.begin_ahead(1.0f / 120);
      if (step == 90) pile.soft[2].translate({0.5f, 0});  // what was begun is done again
      if (step == 120) pile.box2d.SetGravity({1, -9});
    }
    return pile.state();
  };
  EXPECT_EQ(state_of_a_run(true), state_of_a_run(false));
}

TEST(SpeSolver2d, WorkBegunAheadIsDoneAgainWhenTheStepIsAnother) {
  Spes spes;
  b2World world({0, 0});
  Box2dSoftBodies soft(world, spes.solver);
  SoftBody<2>& body = soft.add(man(), {0, 0});
  soft.begin_ahead(0.01f);
  body.add_velocity({1, 0});
  soft.step(0.01f);
  EXPECT_NEAR(body.velocities()[0].x(), 1, 2e-4f);
  soft.begin_ahead(0.01f);
  soft.step(0.0025f);
  EXPECT_NEAR(body.velocities()[0].x(), 1, 2e-4f);
  EXPECT_NEAR(body.positions()[0].x() - body.model().lattice().rest_position(0).x(), 0.0125f, 1e-4f);
}

TEST(SpeSolver2d, WorkBegunAheadRunsWhileTheThreadIsElsewhere) {
  Spes spes;
  Pile pile(spes.solver);
  pile.run(1);
  const std::uint64_t before = spes.jobs_done();
  pile.soft.begin_ahead(1.0f / 120);
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (spes.jobs_done() == before && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_GT(spes.jobs_done(), before);
  pile.run(1);
}

/// Directions that regions keep when they have none of their own show in bits.
TEST(SpeSolver2d, ABodyKeepsItsRotationsWhenOthersComeAndGo) {
  const auto flattened_after = [](bool others, bool reset) {
    Spes spes;
    SoftBody<2> body(man()), other(man());
    for (std::size_t i = 0; i < body.model().particles(); ++i)
      body.set_particle(i, Eigen::Rotation2Df(1) * body.position(i), {0, 0});
    const auto step = [&](std::span<SoftBody<2>* const> bodies) {
      spes.solver.kick(bodies, 0.01f);
      spes.solver.finish();
    };
    step(std::vector{&body});
    if (others) step(std::vector{&other, &body});
    for (std::size_t i = 0; i < body.model().particles(); ++i) body.set_particle(i, {0, 0}, {0, 0});
    if (reset) spes.solver.forget(body);
    step(std::vector{&body});
    return state_hash(body);
  };
  EXPECT_EQ(flattened_after(true, false), flattened_after(false, false));
  EXPECT_NE(flattened_after(false, true), flattened_after(false, false)) << "it was of no consequence";
}

TEST(SpeSolver2d, SleepingBodiesHaveNoJob) {
  Spes spes;
  b2World world({0, -9.81f});
  b2PolygonShape floor;
  floor.SetAsBox(20, 1, {0, -1}, 0);
  const b2BodyDef fixed;
  world.CreateBody(&fixed)->CreateFixture(&floor, 0);
  Box2dSoftBodies soft(world, spes.solver);
  soft.let_sleep(SleepSettings{});
  SoftBodySettings calm = rubber_sheet();
  calm.damping = 0.3f;
  const auto model = rectangle_model({5, 4}, calm);
  SoftBody<2>& low = soft.add(model, {0, 0.1f});
  SoftBody<2>& high = soft.add(model, {3, 0.2f});
  for (int i = 0; i < 1200; ++i) soft.step(1.0f / 120);
  ASSERT_TRUE(low.asleep() && high.asleep());
  const std::uint64_t before = spes.jobs_done();
  const std::uint64_t state = state_hash(low);
  for (int i = 0; i < 30; ++i) soft.step(1.0f / 120);
  EXPECT_EQ(spes.jobs_done(), before);
  EXPECT_EQ(state_hash(low), state);

  high.translate({-3, 1.2f});  // what is changed wakes
  for (int i = 0; i < 2; ++i) soft.step(1.0f / 120);
  EXPECT_FALSE(high.asleep());
  EXPECT_TRUE(low.asleep());
  EXPECT_GT(spes.jobs_done(), before);
  for (int i = 0; i < 90; ++i) soft.step(1.0f / 120);  // and so does what it falls upon
  EXPECT_FALSE(low.asleep());
  EXPECT_NE(state_hash(low), state);
}

TEST(SpeSolver2d, ANanThatThePpuFindsLeavesNoJobUnderWay) {
  Spes spes;
  b2World world({0, 0});
  Box2dSoftBodies soft(world, spes.solver, ContactMethod::kSpheres);
  SoftBody<2>& large = soft.add(rectangle_model({45, 45}, rubber_sheet()), {0, 0});
  SoftBody<2>& small = soft.add(man(), {20, 0});
  large.set_velocity(7, {std::nanf(""), 0});
  large.add_velocity({0, 0});  // tells the coupling of the change
  EXPECT_THROW(soft.step(0.01f), std::runtime_error);
  large.reset({0, 0});
  bend(small);
  const float bent = small.deformation();
  for (int i = 0; i < 3; ++i) soft.step(0.01f);  // with the same bodies, whose chain is used again
  EXPECT_LT(small.deformation(), bent);
}

}  // namespace
}  // namespace softcell::ppu
