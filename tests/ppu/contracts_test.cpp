// What callers of soft bodies and job chains must keep to: an assertion names who does not, with the values.

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "../support/contract.h"
#include "ppu/bodies/step_ahead.h"
#include "ppu/matching/summation.h"
#include "ppu/plans/tile_places.h"
#include "soft_body_scenes.h"
#include "softcell/jobs/job_system.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/skinned_mesh.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_runtime.h"
#include "softcell/spu_kernels/load_kernel.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

std::shared_ptr<const SoftBodyModel<3>> cube() { return block_model({1, 1, 1}, {.cell_size = 0.1f}); }

TEST(SoftBodyContractsDeathTest, ABodyHasAModel) {
  SC_EXPECT_VIOLATES(SoftBody<3>(nullptr), "a soft body without a model\n");
  SC_EXPECT_VIOLATES(SkinnedMesh(nullptr), "a skinned mesh without a model\n");
  World world;
  EXPECT_THROW(world.soft.add(nullptr, {0, 0, 0}), std::invalid_argument) << "also without assertions";
}

TEST(SoftBodyContractsDeathTest, ARestMeshIsOfABodyWithAMesh) {
  SC_EXPECT_VIOLATES(static_cast<void>(rest_mesh(SoftBody<3>(cube()))), "a body of 8 particles has no mesh");
}

TEST(SoftBodyContractsDeathTest, ABodyStaysWithinTheFiniteWorld) {
  SoftBody<3> body(cube());
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  SC_EXPECT_VIOLATES(body.translate({kInfinity, 0, 0}),
                     "translate.*: a body of 8 particles is moved to infinity");
  SC_EXPECT_VIOLATES(body.reset({0, -kInfinity, 0}), "reset.*: a body of 8 particles is moved to infinity");
  SC_EXPECT_VIOLATES(body.move_without_force(Eigen::Quaternionf::Identity(), {0, 0, kInfinity}),
                     "move_without_force.*: a body of 8 particles is moved to infinity");
}

TEST(SoftBodyContractsDeathTest, AVelocityIsFinite) {
  SoftBody<3> body(cube());
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  SC_EXPECT_VIOLATES(body.add_velocity({0, kNan, 0}),
                     "add_velocity.*: infinity or NaN is added to the velocities of 8 particles");
  SC_EXPECT_VIOLATES(
      body.add_particle_velocity(3, {kInfinity, 0, 0}),
      "add_particle_velocity.*: infinity or NaN is added to the velocity of particle 3 of 8\n");
  SC_EXPECT_VIOLATES(body.add_angular_velocity({0, 0, kInfinity}),
                     "add_angular_velocity.*: infinity or NaN is added to the velocities of 8 particles");
  SC_EXPECT_VIOLATES(body.add_angular_velocity({kNan, 0, 0}),
                     "add_angular_velocity.*: infinity or NaN is added to the velocities of 8 particles");
}

TEST(SoftBodyContractsDeathTest, ARotationIsNoZero) {
  SoftBody<3> body(cube());
  SC_EXPECT_VIOLATES(body.move_without_force(Eigen::Quaternionf(0, 0, 0, 0), {0, 0, 0}),
                     "a quaternion of length 0 is no rotation\n");
}

TEST(SoftBodyContractsDeathTest, AParticleHasANumber) {
  SoftBody<3> body(cube());
  SC_EXPECT_VIOLATES(body.add_particle_velocity(8, {1, 0, 0}), "add_particle_velocity.*: particle 8 of 8\n");
  SC_EXPECT_VIOLATES(body.set_particle(8, {0, 0, 0}, {0, 0, 0}), "set_particle.*: particle 8 of 8\n");
  SC_EXPECT_VIOLATES(body.set_velocity(8, {0, 0, 0}), "set_velocity.*: particle 8 of 8\n");
  const std::vector<std::uint32_t> too_far(8, 8);
  SC_EXPECT_VIOLATES(SoftBody<3>(cube()).inherit_state(body, too_far, {0, 0, 0}),
                     "inherit_state.*: particle 0 of a piece is particle 8 of 8\n");
  const std::vector<std::uint32_t> all_first(8, 0);
  SC_EXPECT_VIOLATES(SoftBody<3>(cube()).inherit_state(body, all_first, {0, 0, 0}),
                     "inherit_state.*: a body of 8 particles that is no piece inherits a state\n");
}

TEST(SoftBodyContractsDeathTest, TimeGoesForward) {
  SoftBody<3> body(cube());
  SC_EXPECT_VIOLATES(body.advance_inner(0, {0, -9.81f, 0}), "advance_inner.*: a time step of 0 s\n");
  SC_EXPECT_VIOLATES(static_cast<void>(body.model().settings().alpha_of_step(-1)),
                     "alpha_of_step.*: a time step of -1 s\n");
}

TEST(SoftBodyContractsDeathTest, AMeshWithABoxHasPositions) {
  TriangleMesh none;
  SC_EXPECT_VIOLATES(bounds(none), "bounds.*: a mesh without positions has no box\n");
  SC_EXPECT_VIOLATES(fit(none, 1), "a mesh without positions has no box\n");
  TriangleMesh one;
  one.positions = {{0, 0, 0}};
  SC_EXPECT_VIOLATES(fit(one, 0), "fit.*: a longest side of 0 m\n");
}

TEST(SoftBodyContractsDeathTest, AHashIsOneOfBodies) {
  const std::array<const SoftBody<3>*, 1> none{nullptr};
  SC_EXPECT_VIOLATES(state_hash(none), "state_hash.*: one of 1 bodies is null\n");
}

TEST(SoftBodyContractsDeathTest, ALatticeHasAFillForEachCell) {
  const std::array<Eigen::Vector2i, 2> cells{Eigen::Vector2i(0, 0), Eigen::Vector2i(1, 0)};
  Lattice<2> lattice = lattice_from_cells(cells, 0.1f);
  lattice.fill.pop_back();
  SC_EXPECT_VIOLATES(particle_masses(lattice, 1),
                     "particle_masses.*: 2 cells with 1 fills and the corners of 2\n");
}

TEST(SoftBodyContractsDeathTest, AStepAheadKnowsItsBodies) {
  PpuSolver<3> solver;
  StepAhead<3> steps(solver);
  SoftBody<3> body(cube());
  SC_EXPECT_VIOLATES(steps.remove(body), "remove.*: a body that is none of these 0\n");
  steps.add(body);
  SC_EXPECT_VIOLATES(steps.add(body), "add.*: a body is added twice to 1\n");
  steps.begin(0.01f);
  SC_EXPECT_VIOLATES(steps.forget(body), "forget.*: a body is forgotten during its step of 0\\.01 s\n");
}

TEST(SoftBodyContractsDeathTest, ASolverDoesOneStepAtATime) {
  SoftBody<3> body(cube());
  const std::array<SoftBody<3>*, 1> bodies{&body};
  PpuSolver<3> solver;
  solver.kick(bodies, 0.01f);
  SC_EXPECT_VIOLATES(solver.kick(bodies, 0.01f),
                     "kick.*: kick\\(\\) of 1 bodies while a step of 1 is under way\n");
  SC_EXPECT_VIOLATES(solver.forget(body), "forget.*: forget\\(\\) while a step of 1 bodies is under way\n");
  body.set_particle(0, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 0, 0});
  EXPECT_THROW(solver.finish(), std::runtime_error);
  solver.forget(body);  // the step that failed has ended
}

TEST(SoftBodyContractsDeathTest, ASolverStepsBodiesForATimeAboveZero) {
  SoftBody<3> body(cube());
  const std::array<SoftBody<3>*, 1> bodies{&body};
  const std::array<SoftBody<3>*, 2> with_none{&body, nullptr};
  PpuSolver<3> solver;
  SC_EXPECT_VIOLATES(solver.kick(bodies, 0), "kick.*: a time step of 0 s\n");
  SC_EXPECT_VIOLATES(solver.kick(bodies, std::numeric_limits<float>::infinity()),
                     "kick.*: a time step of inf s\n");
  SC_EXPECT_VIOLATES(solver.kick(with_none, 0.01f), "kick.*: one of 2 bodies is null\n");
}

TEST(SoftBodyContractsDeathTest, ASkinIsPulledByParticlesOfItsBody) {
  const std::array<Eigen::Vector2i, 1> cells{Eigen::Vector2i(0, 0)};
  const Lattice<2> lattice = lattice_from_cells(cells, 0.1f);
  const Skin2d skin = make_skin_2d(lattice, 0.1f);
  const std::vector<Eigen::Vector2f> particles(3, Eigen::Vector2f::Zero());
  std::vector<Eigen::Vector2f> positions(skin.rest.size()), slopes(skin.rest.size());
  SC_EXPECT_VIOLATES(deform(skin, particles, positions, slopes),
                     "deform.*: vertex .* is pulled by particle 3 of 3\n");
}

TEST(SoftBodyContractsDeathTest, ParticlesOfAPlanAreSorted) {
  const std::array<Eigen::Vector3i, 2> particles{Eigen::Vector3i(1, 0, 0), Eigen::Vector3i(0, 0, 0)};
  Csr regions;
  for (int r = 0; r < 2; ++r) regions.push(std::array<std::uint32_t, 2>{0, 1});
  SC_EXPECT_VIOLATES(SumPlan(particles, regions), "SumPlan.*: 2 particles are not sorted by x, y and z\n");
}

TEST(SoftBodyContractsDeathTest, SitesOfTilesAscend) {
  const std::vector<Eigen::Vector3i> sites{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  SC_EXPECT_VIOLATES(TilePlaces({.planes = 4, .rows = 4}, sites), "plane 0 has tile row 0 in two pieces");
}

TEST(JobContractsDeathTest, AChainIsFilledAndKickedWhenItHasFinished) {
  SpeRuntime spes({.spes = 1});
  JobChain chain(spes.jobs(), "empty", 1);
  SC_EXPECT_VIOLATES(chain.add({}), "add.*: job 0 has no image; JobSystem::load\\(\\) returns one\n");
}

/// Whether the jobs have ended by then makes no difference: who does not ask may not go on.
TEST(JobContractsDeathTest, WhoKicksAChainAsksWhetherItHasFinished) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // SPEs have threads
  SpeRuntime spes({.spes = 1});
  const ls_sim::KernelImage kernel = spu_kernels::load_kernel("transfers");
  JobChain chain(spes.jobs(), "kicked", 1);
  chain.add({.image = spes.jobs().load(kernel), .argp = {}});  // returns at once
  chain.kick();
  SC_EXPECT_VIOLATES(chain.kick(), "kick.*: kick\\(\\) while the chain's 1 jobs are under way\n");
  SC_EXPECT_VIOLATES(chain.clear(), "clear.*: clear\\(\\) while the chain's 1 jobs are under way\n");
  SC_EXPECT_VIOLATES(static_cast<void>(chain.failures()), "failures.*: failures\\(\\) of 1 jobs without");
  chain.wait();
  EXPECT_TRUE(chain.failures().empty());
}

TEST(JobContractsDeathTest, ChainsEndBeforeTheirSystem) {
  auto spes = std::make_unique<SpeRuntime>(SpeRuntimeOptions{.spes = 1});
  JobChain chain(spes->jobs(), "longer", 1);
  SC_EXPECT_VIOLATES(spes.reset(), "a job system ends before 1 of its chains\n");
}

}  // namespace
}  // namespace softcell::ppu
