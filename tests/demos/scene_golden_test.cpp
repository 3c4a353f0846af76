// Both scenes at three moments, as pictures that were looked at.

#include <gtest/gtest.h>

#include "scene_file/scene_library.h"
#include "scene_view.h"
#include "simulation_3d.h"
#include "softcell/render/offscreen_context.h"
#include "support/golden.h"

namespace softcell::demos {
namespace {

struct Moment {
  const char* scene;
  int frame;
};

void PrintTo(const Moment& m, std::ostream* out) { *out << m.scene << " " << m.frame; }

class SceneGolden : public testing::TestWithParam<Moment> {};

TEST_P(SceneGolden, LooksAsItDid) {
  const Scene scene = load_scene_3d(GetParam().scene);
  Simulation3d simulation(scene, {});
  for (int frame = 0; frame < GetParam().frame; ++frame) simulation.step();
  simulation.finish();
  const auto context = render::create_offscreen_context();
  render::Renderer renderer(*context, {.width = 480, .height = 270});
  SceneView view(scene, simulation, renderer, View::kMesh);
  EXPECT_TRUE(test::compare_with_golden(
      view.draw(), std::string(GetParam().scene) + "_" + std::to_string(GetParam().frame)));
}

// Early moments: later ones hang on the last bit of the C library's sine, which differs between processor
// generations.
INSTANTIATE_TEST_SUITE_P(Moments, SceneGolden,
                         testing::Values(Moment{"arena", 1}, Moment{"arena", 45}, Moment{"arena", 90},
                                         Moment{"drop", 1}, Moment{"drop", 35}, Moment{"drop", 90}));

TEST(SceneGolden, TheLatticeViewLooksAsItDid) {
  const Scene scene = load_scene_3d("drop");
  Simulation3d simulation(scene, {});
  const auto context = render::create_offscreen_context();
  render::Renderer renderer(*context, {.width = 480, .height = 270});
  SceneView view(scene, simulation, renderer, View::kLattice);
  EXPECT_TRUE(test::compare_with_golden(view.draw(), "drop_lattice"));
}

}  // namespace
}  // namespace softcell::demos

int main(int argc, char** argv) {
  softcell::render::pin_software_rasterizer();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
