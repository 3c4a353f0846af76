// The same scene with vertices made by the SPEs and by the GPU: the same state, the same pictures.

#include <gtest/gtest.h>

#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/render/image_compare.h"
#include "softcell/render/offscreen_context.h"
#include "support/slow_build.h"
#include "view/scene_view.h"

namespace softcell::demos {
namespace {

/// A scene with one way of skinning, and its pictures.
struct Skinned {
  Skinned(const Scene& scene, Skin skin, render::GlContext& context)
      : simulation(scene, {.skin = skin}),
        renderer(context, {.width = 480, .height = 270}),
        view(scene, simulation, renderer, View::kMesh) {}

  Simulation3d simulation;
  render::Renderer renderer;
  SceneView view;
};

class GpuSkin : public testing::TestWithParam<const char*> {};

// The newest frame is not waited for: both are one frame late, or the pictures would differ by a frame's
// motion.
//
// About one vertex in a thousand is rounded to another half, because the SPEs truncate and the GPU rounds.
// Seldom that moves an outline over a pixel's sample, which the golden rule forgives nobody. So at each
// moment the share of differing pixels is the golden rule's and outlines may differ in a few, and most
// pictures are within all of the rule.
TEST_P(GpuSkin, GivesThePicturesOfTheSpes) {
  constexpr int kPictures = 6, kFramesBetween = 15;
  constexpr std::size_t kOutlinePixels = 12;
  const Scene scene = load_scene_3d(GetParam());
  if (kSlowBuild && scene.name != "arena")
    GTEST_SKIP() << "too slow with sanitizers, which run it for the scene arena";
  const auto context = render::create_offscreen_context();
  Skinned spe(scene, Skin::kSpe, *context), gpu(scene, Skin::kGpu, *context);
  int within = 0;
  for (int picture = 0; picture < kPictures; ++picture) {
    for (int frame = 0; frame < kFramesBetween; ++frame) {
      spe.simulation.step();
      gpu.simulation.step();
    }
    ASSERT_EQ(spe.simulation.state_hash(), gpu.simulation.state_hash());
    const render::ImageDifference difference = render::compare(gpu.view.draw(), spe.view.draw());
    EXPECT_LE(static_cast<double>(difference.over_0),
              render::kGoldenMaxDifferingShare * static_cast<double>(difference.pixels))
        << render::describe(difference);
    EXPECT_LE(difference.over_2, kOutlinePixels) << render::describe(difference);
    within += render::within_golden_rule(difference);
  }
  EXPECT_GT(2 * within, kPictures);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GpuSkin,
                         testing::Values("arena", "torus_on_spike", "bumper_car", "painted"));

TEST(GpuSkinJobs, NoneAreLeftForTheSpes) {
  const Scene scene = load_scene_3d("drop");
  const auto jobs_of = [&](Solver solver, Skin skin) {
    Simulation3d simulation(scene, {.solver = solver, .skin = skin});
    for (int frame = 0; frame < 10; ++frame) simulation.step();
    EXPECT_GT(simulation.vertices(), 0u);
    simulation.stop();
    std::uint64_t jobs = 0;
    for (const ls_sim::SpeStatistics& spe : simulation.spe_statistics()) jobs += spe.jobs;
    return jobs;
  };
  const std::uint64_t neither = jobs_of(Solver::kReference, Skin::kGpu);
  const std::uint64_t skinning = jobs_of(Solver::kReference, Skin::kSpe) - neither;
  EXPECT_GE(skinning, 11u) << "one for the beginning, and one for each frame";
  EXPECT_EQ(jobs_of(Solver::kSpe, Skin::kSpe) - jobs_of(Solver::kSpe, Skin::kGpu), skinning);
}

TEST(GpuSkinShown, IsOneFrameLate) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d simulation(scene, {.skin = Skin::kGpu});
  const float before = simulation.soft_body(0).positions()[0].y();
  EXPECT_EQ(simulation.shown_particles(0)[0].y(), before);
  simulation.step();
  const float after = simulation.soft_body(0).positions()[0].y();
  ASSERT_NE(after, before);
  EXPECT_EQ(simulation.shown_particles(0)[0].y(), before);
  simulation.finish();
  EXPECT_EQ(simulation.shown_particles(0)[0].y(), after);
  simulation.finish();  // nothing is under way
  EXPECT_EQ(simulation.shown_particles(0)[0].y(), after);
  EXPECT_TRUE(simulation.shown(0).vertices.empty());
}

}  // namespace
}  // namespace softcell::demos
