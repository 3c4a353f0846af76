// One object for all that SPEs need, and vertex buffers from it.

#include "softcell/spe_bodies/spe_runtime.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "soft_body_scenes.h"
#include "softcell/box2d/box2d_soft_bodies.h"
#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/timing.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/skinned_mesh.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_skinner.h"
#include "softcell/spe_bodies/spe_solver.h"
#include "spu_kernels/kernel_image.h"
#include "support/float_from_half.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

std::shared_ptr<const SoftBodyModel<3>> ball() {
  TriangleMesh mesh = make_sphere(0.5f, 8);
  for (const Vector3f& p : mesh.positions) mesh.texture_coordinates.emplace_back(p.x(), p.z());
  return make_soft_body_model(mesh, {.cell_size = 0.2f});
}

/// A ball falls on a floor. @return the hash of its state.
std::uint64_t fall(SolverFactory& solvers, int frames, ContactMethod contacts = ContactMethod::kSurface) {
  BulletWorld bullet;
  BulletSoftBodies bodies(bullet.world(), solvers, contacts);
  bullet.add_box({20, 1, 20}, 0, {0, -0.5f, 0}, 0.6f);
  const SoftBody<3>& body = bodies.add(ball(), {0, 0.8f, 0});
  for (int i = 0; i < frames; ++i) bullet.step(kFrame, 2);
  EXPECT_LT(body.centre_of_mass().y(), 0.79f);  // it may have bounced
  EXPECT_GT(body.centre_of_mass().y(), 0.3f);
  return state_hash(body);
}

TEST(SpeRuntime, StepsBodiesAsAnSpeSolverDoesThatWasPutTogetherByHand) {
  struct ByHand final : SolverFactory {
    std::unique_ptr<SoftBodySolver<3>> make_solver() override {
      return std::make_unique<SpeSolver<3>>(memory, jobs, MatchKernels<3>{match, match_tiles});
    }
    std::unique_ptr<SoftBodySolver<2>> make_solver_2d() override { return nullptr; }
    dma::AddressSpace memory;
    ls_sim::KernelImage job_loop = softcell::test::kernel_image("job_loop"),
                        match = softcell::test::kernel_image("match"),
                        match_tiles = softcell::test::kernel_image("match_tiles");
    JobSystem jobs{memory, {.spes = 3}, job_loop};
  } by_hand;
  SpeRuntime runtime({.spes = 2});
  EXPECT_EQ(runtime.spes(), 2);
  // With spheres: contacts of what is drawn would be the runtime's SPEs' here, and there this thread's.
  EXPECT_EQ(fall(runtime, 40, ContactMethod::kSpheres), fall(by_hand, 40, ContactMethod::kSpheres));
}

TEST(SpeRuntime, ServesSeveralWorldsUnderEverySchedule) {
  SpeRuntime eager, lazy({.spes = 1, .schedule = dma::parse_schedule("lazy")});
  const std::uint64_t expected = fall(eager, 30);
  EXPECT_EQ(fall(eager, 30), expected);
  EXPECT_EQ(fall(lazy, 30), expected);
  EXPECT_TRUE(eager.findings().empty());
  std::uint64_t jobs = 0;
  for (const ls_sim::SpeStatistics& spe : eager.statistics()) jobs += spe.jobs;
  EXPECT_GT(jobs, 0u);
}

/// What a body's fall takes by the model of time, and its state behind it.
struct TimedFall {
  std::uint64_t cycles = 0, hash = 0;
  std::vector<ls_sim::KernelCycles> kernels;
};

TimedFall timed_fall(int spes, const char* schedule = "eager") {
  ls_sim::Timing timing(spes);
  TimedFall result;
  {
    SpeRuntime runtime({.spes = spes,
                        .schedule = dma::parse_schedule(schedule),
                        .machine = ls_sim::Machine::kSpu,
                        .timing = &timing});
    result.hash = fall(runtime, 30);
  }
  result.cycles = timing.now();
  result.kernels = timing.by_kernel();
  return result;
}

TEST(SpeRuntime, CountsTheCyclesOfAPs3) {
  SpeRuntime plain;
  const std::uint64_t expected = fall(plain, 30);
  const TimedFall once = timed_fall(2), again = timed_fall(2), lazy = timed_fall(2, "lazy");
  EXPECT_EQ(once.hash, expected);
  EXPECT_EQ(once.cycles, again.cycles);
  EXPECT_EQ(once.cycles, lazy.cycles) << "when transfers happen is no matter of the model";
  ASSERT_EQ(once.kernels.size(), 2u);
  std::uint64_t in_kernels = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const ls_sim::KernelCycles& kernel = once.kernels[i];
    EXPECT_EQ(kernel.cycles, again.kernels[i].cycles) << kernel.kernel;
    EXPECT_LT(kernel.waits, kernel.cycles / 2) << kernel.kernel;
    in_kernels += kernel.cycles;
    if (kernel.kernel == "match") {
      EXPECT_EQ(kernel.jobs, 60u) << "30 frames of two substeps";
    } else {
      EXPECT_EQ(kernel.kernel, "contact_solve");
      EXPECT_GT(kernel.jobs, 0u) << "when it has reached the floor";
    }
  }
  EXPECT_LT(in_kernels, once.cycles) << "the loops take something, too";
}

TEST(SpeRuntime, WorldsHaveTheirChainsFromTheBeginningAndAreRefusedWhenThereAreNone) {
  SpeRuntime spes({.spes = 1});
  std::vector<std::unique_ptr<BulletWorld>> worlds;
  std::vector<std::unique_ptr<BulletSoftBodies>> bodies;
  for (int w = 0; w < 5; ++w) {  // of three chains each
    worlds.push_back(std::make_unique<BulletWorld>());
    bodies.push_back(std::make_unique<BulletSoftBodies>(worlds.back()->world(), spes));
  }
  EXPECT_THROW(SpeSkinner{spes}, std::runtime_error);
  BulletWorld sixth;
  EXPECT_THROW(BulletSoftBodies(sixth.world(), spes), std::runtime_error);
  const auto model = ball();
  for (int frame = 0; frame < 4; ++frame)  // which need more room for jobs each time
    for (std::size_t w = 0; w < worlds.size(); ++w) {
      for (int i = 0; i < 3; ++i)
        bodies[w]->add(model, {static_cast<float>(i), 2.0f * static_cast<float>(frame), 0});
      worlds[w]->step(kFrame, 2);
    }
  for (const auto& of_world : bodies) EXPECT_EQ(of_world->size(), 12u);
  for (auto& of_world : bodies) of_world.reset();
  EXPECT_NO_THROW(BulletSoftBodies(sixth.world(), spes));
}

TEST(SpeRuntime, CheckedKernelsGiveTheSameBitsAndNoFindings) {
  SpeRuntime plain({.spes = 2}), checked({.spes = 2, .checked = true});
  EXPECT_TRUE(checked.kernel("match").checked);
  EXPECT_FALSE(plain.kernel("match").checked);
  EXPECT_EQ(fall(checked, 30), fall(plain, 30));
  EXPECT_TRUE(checked.findings().empty());
}

TEST(SpeRuntime, RefusesOtherNumbersOfSpesAndUnknownKernels) {
  for (const int spes : {0, 7, -1}) {
    try {
      const SpeRuntime runtime({.spes = spes});
      FAIL() << spes;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(), "a runtime of " + std::to_string(spes) + " SPEs; 1 to 6 are possible");
    }
  }
  SpeRuntime runtime({.spes = 1});
  EXPECT_THROW(runtime.kernel("no_such"), std::runtime_error);
}

TEST(SpeRuntime, MainMemoryHasTheSizeThatWasAskedFor) {
  SpeRuntime small({.spes = 1, .main_memory_bytes = 1 << 20});
  EXPECT_LT(small.memory().free_bytes(dma::Memory::kMain), 1u << 20);
  BulletWorld bullet;
  BulletSoftBodies bodies(bullet.world(), small);
  const auto large = block_model({20, 20, 20}, {.cell_size = 0.1f});
  bodies.add(large, {0, 0, 0});
  try {
    bullet.step(kFrame, 2);
    FAIL() << "a body of " << large->masses().size() << " particles fits 1 MB";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("main memory"), std::string::npos) << error.what();
  }
  EXPECT_THROW(SpeRuntime({.main_memory_bytes = 1000}), std::invalid_argument);
}

Vector3f position_of(const SkinnedVertices& skinned, std::size_t slot) {
  const auto& p = skinned.vertices[slot].position;
  return skinned.origin + Vector3f(float_from_half(p[0]), float_from_half(p[1]), float_from_half(p[2]));
}

TEST(SpeSkinner, VerticesAreTheMeshsInTheOrderThatItStates) {
  SpeRuntime spes({.spes = 2});
  SpeSkinner skinner(spes);
  SoftBody<3> body(ball(), {3, 2, 1});
  body.move_without_force(Eigen::Quaternionf(Eigen::AngleAxisf(1, Vector3f::UnitY())), {0, 0, 0});
  skinner.add(body);
  EXPECT_TRUE(skinner.vertices(body).vertices.empty());
  ASSERT_TRUE(skinner.begin_frame());
  skinner.finish_frame();

  const TriangleMesh& mesh = body.model().mesh();
  SkinnedMesh exact(body.shared_model());
  exact.update(body);
  const DrawOrder order = draw_order(body.model());
  const SkinnedVertices drawn = skinner.vertices(body);
  ASSERT_EQ(drawn.vertices.size(), order.mesh_vertex.size());
  for (std::size_t i = 0; i < drawn.vertices.size(); ++i) {
    const auto& n = drawn.vertices[i].normal;
    const Vector3f normal(float_from_half(n[0]), float_from_half(n[1]), float_from_half(n[2]));
    ASSERT_LT((position_of(drawn, i) - exact.positions()[order.mesh_vertex[i]]).norm(), 1e-3f) << i;
    ASSERT_LT((normal - exact.normals()[order.mesh_vertex[i]]).norm(), 2e-3f) << i;
  }
  ASSERT_EQ(order.indices.size(), 3 * mesh.triangles.size());
  for (std::size_t i = 0; i < order.indices.size(); ++i)
    ASSERT_EQ(order.mesh_vertex[order.indices[i]], mesh.triangles[i / 3][i % 3]) << i;
  const auto texture = order.reorder(mesh.texture_coordinates);
  for (std::size_t i = 0; i < texture.size(); ++i)
    ASSERT_EQ(texture[i], mesh.texture_coordinates[order.mesh_vertex[i]]) << i;
}

TEST(DrawOrder, ReordersWhatAMeshHas) {
  const std::vector<std::uint32_t> vertices{2, 0, 2};
  const DrawOrder order{.indices = {}, .mesh_vertex = vertices};
  EXPECT_EQ(order.reorder(std::vector<int>{5, 6, 7}), (std::vector<int>{7, 5, 7}));
  EXPECT_TRUE(order.reorder(std::vector<int>{}).empty()) << "a mesh without the attribute";
  try {
    order.reorder(std::vector<int>{5, 6});
    FAIL() << "vertex 2 has no value";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(
        error.what(),
        "a mesh attribute has 2 values, but vertex 2 needs one; give one value for each vertex, or none");
  }
}

TEST(SpeSkinner, ShowsTheFrameBefore) {
  SpeRuntime spes({.spes = 1});
  SpeSkinner skinner(spes);
  SoftBody<3> body(ball());
  skinner.add(body);
  const auto begin = [&] {
    while (!skinner.begin_frame()) {  // the SPEs are not yet done
    }
  };
  begin();  // at 0
  EXPECT_TRUE(skinner.vertices(body).vertices.empty());
  body.translate({1, 0, 0});
  begin();  // at 1; the first is finished
  const float at_0 = position_of(skinner.vertices(body), 0).x();
  body.translate({1, 0, 0});
  begin();  // at 2
  EXPECT_NEAR(position_of(skinner.vertices(body), 0).x(), at_0 + 1, 1e-3f);
  skinner.finish_frame();
  EXPECT_NEAR(position_of(skinner.vertices(body), 0).x(), at_0 + 2, 1e-3f);
}

TEST(SpeSkinner, BodiesComeAndGo) {
  SpeRuntime spes({.spes = 2});
  SpeSkinner skinner(spes);
  const auto model = ball();
  SoftBody<3> first(model), second(model, {5, 0, 0}), third(model, {9, 0, 0});
  skinner.add(first);
  skinner.add(second);
  ASSERT_TRUE(skinner.begin_frame());
  skinner.add(third);  // which waits for the frame
  EXPECT_FALSE(skinner.vertices(first).vertices.empty());
  EXPECT_TRUE(skinner.vertices(third).vertices.empty());
  ASSERT_TRUE(skinner.begin_frame());
  skinner.remove(first);
  EXPECT_NEAR(position_of(skinner.vertices(second), 0).x() + 4, position_of(skinner.vertices(third), 0).x(),
              2e-3f);
  ASSERT_TRUE(skinner.begin_frame());
  skinner.finish_frame();
  EXPECT_NEAR(position_of(skinner.vertices(second), 0).x() + 4, position_of(skinner.vertices(third), 0).x(),
              2e-3f);
  EXPECT_THROW(skinner.vertices(first), std::invalid_argument);
  EXPECT_THROW(skinner.remove(first), std::invalid_argument);
  EXPECT_THROW(skinner.add(second), std::invalid_argument);
  skinner.remove(second);
  skinner.remove(third);
  const std::uint64_t free = spes.memory().free_bytes(dma::Memory::kMain);
  skinner.add(first);
  skinner.remove(first);
  EXPECT_EQ(spes.memory().free_bytes(dma::Memory::kMain), free);
}

TEST(SpeSkinner, RefusesABodyWhoseModelHasChanged) {
  SpeRuntime spes({.spes = 1});
  SpeSkinner skinner(spes);
  SoftBody<3> body(ball());
  skinner.add(body);
  ASSERT_TRUE(skinner.begin_frame());
  skinner.finish_frame();
  const SoftBody<3> saved = body;
  body = saved;
  EXPECT_TRUE(skinner.begin_frame()) << "a copy of it has its model";
  skinner.finish_frame();
  body = SoftBody<3>(ball());  // as many particles, and yet another model
  try {
    skinner.begin_frame();
    ADD_FAILURE() << "it has begun a frame";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(
        e.what(),
        "SpeSkinner: body 0 of 1 has another model than when it was added: it has broken, was cut, or got "
        "a body of another model; call remove() and add() for it");
  }
  skinner.remove(body);
  skinner.add(body);
  EXPECT_TRUE(skinner.begin_frame());
  skinner.finish_frame();
}

TEST(SpeSkinner, RefusesAModelWithoutAMesh) {
  SpeRuntime spes({.spes = 1});
  SpeSkinner skinner(spes);
  const SoftBody<3> block(block_model({2, 2, 2}, {.cell_size = 0.1f}));
  EXPECT_THROW(skinner.add(block), std::invalid_argument);
  EXPECT_TRUE(skinner.begin_frame());  // nothing to do is no mistake
  skinner.finish_frame();
}

/// A game that makes models while it runs, level after level, would grow for ever.
TEST(SoftBodies, LetGoOfAModelThatNobodyElseHas) {
  SpeRuntime spes({.spes = 2});
  for (const bool on_spes : {false, true}) {
    BulletWorld bullet;
    const auto owned = on_spes ? std::make_unique<BulletSoftBodies>(bullet.world(), spes)
                               : std::make_unique<BulletSoftBodies>(bullet.world());
    BulletSoftBodies& bodies = *owned;
    bullet.add_box({20, 1, 20}, 0, {0, -0.5f, 0}, 0.6f);
    const auto kept = ball();
    SoftBody<3>* first = &bodies.add(kept, {0, 0.4f, 0});
    std::weak_ptr<const SoftBodyModel<3>> one, broken;
    {
      auto model = ball();
      one = model;
      const SoftBody<3>& body = bodies.add(std::move(model), {2, 0.4f, 0});
      auto brittle = make_soft_body_model(make_box({0.8f, 0.8f, 0.8f}, 0.2f),
                                          {.cell_size = 0.2f, .fracture = Fracture{}});
      broken = brittle;
      SoftBody<3>& whole = bodies.add(std::move(brittle), {-2, 0.5f, 0});
      for (int i = 0; i < 4; ++i) bullet.step(kFrame, 2);
      const auto pieces = bodies.cut(whole, Cut::plane({-2, 0.5f, 0}, {0, 1, 0}));
      ASSERT_FALSE(pieces.empty());
      for (int i = 0; i < 4; ++i) bullet.step(kFrame, 2);
      EXPECT_FALSE(broken.expired()) << "pieces are made from the whole";
      for (const SoftBody<3>* piece : pieces) bodies.remove(*piece);
      bodies.remove(whole);
      bodies.remove(body);
    }
    bullet.step(kFrame, 2);
    // Another thread disposes of a large body that has broken.
    for (int i = 0; i < 500 && !broken.expired(); ++i) {
      bullet.step(kFrame, 2);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_TRUE(one.expired()) << (on_spes ? "SPEs" : "PPU");
    EXPECT_TRUE(broken.expired());
    // Another body of a model that the program has kept finds what was made of it.
    bodies.remove(*first);
    first = &bodies.add(kept, {0, 0.4f, 0});
    for (int i = 0; i < 60; ++i) bullet.step(kFrame, 2);
    EXPECT_GT(first->centre_of_mass().y(), 0.3f);
  }
}

TEST(SoftBodies2d, LetGoOfAModelThatNobodyElseHas) {
  SpeRuntime spes({.spes = 2});
  for (const bool on_spes : {false, true}) {
    b2World world({0, -9.81f});
    const auto owned =
        on_spes ? std::make_unique<Box2dSoftBodies>(world, spes) : std::make_unique<Box2dSoftBodies>(world);
    Box2dSoftBodies& bodies = *owned;
    std::weak_ptr<const SoftBodyModel<2>> one;
    {
      auto model =
          make_soft_body_model(lattice_from_cells(cells_from_rows(std::vector<std::string>(4, "####")), 0.1f),
                               SoftBodySettings{.cell_size = 0.1f, .fracture = Fracture{}});
      one = model;
      SoftBody<2>& whole = bodies.add(std::move(model), {0, 0});
      bodies.step(kFrame);
      const auto pieces = bodies.cut(whole, Cut2d::line(whole.centre_of_mass(), {0, 1}));
      ASSERT_FALSE(pieces.empty());
      bodies.step(kFrame);
      EXPECT_FALSE(one.expired()) << "pieces are made from the whole";
      for (const SoftBody<2>* piece : pieces) bodies.remove(*piece);
      bodies.remove(whole);
    }
    bodies.step(kFrame);
    EXPECT_TRUE(one.expired()) << (on_spes ? "SPEs" : "PPU");
  }
}

}  // namespace
}  // namespace softcell::ppu
