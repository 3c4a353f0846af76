// Equal bodies have one model, whatever stands between them.

#include "scene/shared_models.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "simulation/simulation_3d.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::demos {
namespace {

TEST(SharedModels, OneForEachKindInTheOrderOfBodies) {
  const std::vector<int> bodies = {7, 8, 7, 7, 9, 8};
  std::vector<std::size_t> made;
  const auto models = shared_models(
      bodies.size(), [&](std::size_t i, std::size_t j) { return bodies[i] == bodies[j]; },
      [&](std::size_t i) {
        made.push_back(i);
        return std::make_shared<int>(bodies[i]);
      });
  EXPECT_EQ(made, (std::vector<std::size_t>{0, 1, 4}));
  ASSERT_EQ(models.size(), bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) EXPECT_EQ(*models[i], bodies[i]);
  EXPECT_EQ(models[0], models[2]);
  EXPECT_EQ(models[1], models[5]);
}

/// Two boxes of which the second has another colour and place, and what `change` makes of it.
template <typename Change>
Simulation3d two_boxes(const Change& change) {
  Scene scene;
  SoftBodyPlacement box;
  box.mesh = ppu::make_box({0.4f, 0.4f, 0.4f}, 0.1f);
  box.settings.cell_size = 0.1f;
  scene.soft_bodies = {box, box};
  scene.soft_bodies[1].position = {0, 2, 0};
  scene.soft_bodies[1].colour = {1, 0, 0};
  change(scene.soft_bodies[1]);
  return Simulation3d(scene, {});
}

bool shared(const Simulation3d& simulation) {
  return simulation.soft_body(0).shared_model() == simulation.soft_body(1).shared_model();
}

TEST(SharedModels, BodiesOfASceneThatDifferInPlaceAndColourAlone) {
  EXPECT_TRUE(shared(two_boxes([](SoftBodyPlacement&) {})));
  EXPECT_FALSE(shared(two_boxes([](SoftBodyPlacement& box) { box.settings.frequency = 3; })));
  EXPECT_FALSE(shared(two_boxes([](SoftBodyPlacement& box) { box.mesh.positions[0].x() -= 0.01f; })));
}

}  // namespace
}  // namespace softcell::demos
