// What a scene's script does to a simulation.

#include <gtest/gtest.h>

#include "scene_file/scene_library.h"
#include "script_player.h"
#include "simulation_3d.h"
#include "softcell/ppu/soft_body_2d.h"

namespace softcell::demos {
namespace {

Scene floating_cube(const std::string& script) {
  return std::get<Scene>(
      parse_scene("world = { gravity = 0 }\n"
                  "[[soft_body]]\nname = \"cube\"\ncell_size = 0.25\n"
                  "shape = { kind = \"box\", size = [0.5, 0.5, 0.5] }\n" +
                      script,
                  "s.toml"));
}

void run(Simulation3d& simulation, int frames) {
  for (int i = 0; i < frames; ++i) simulation.step();
}

TEST(Script, AnImpulseIsGivenOnceAndAtItsTime) {
  const Scene scene = floating_cube("[[impulse]]\ntime = 0.5\nbody = \"cube\"\nvelocity = [1, 2, 3]\n");
  Simulation3d simulation(scene, {});
  run(simulation, 30);
  EXPECT_EQ(simulation.soft_body(0).linear_momentum().norm(), 0);
  run(simulation, 30);
  const float mass = simulation.model(0).mass();
  EXPECT_LT((simulation.soft_body(0).linear_momentum() / mass - Eigen::Vector3f(1, 2, 3)).norm(), 0.01f);
}

TEST(Script, GravityChangesAtItsTime) {
  const Scene scene =
      floating_cube("[[gravity]]\ntime = 0\nvalue = -6\n[[gravity]]\ntime = 0.5\nvalue = 0\n");
  Simulation3d simulation(scene, {});
  run(simulation, 60);
  const Eigen::Vector3f velocity = simulation.soft_body(0).linear_momentum() / simulation.model(0).mass();
  EXPECT_NEAR(velocity.y(), 3, 0.05f) << "half a second upwards";
}

TEST(Script, AHandTakesABodyAlongAndLetsGo) {
  const Scene scene = floating_cube(
      "[[drag]]\nbody = \"cube\"\nbegin = 0\nend = 2\n"
      "from = [0.25, 0, 0]\nto = [3.25, 0, 0]\n");
  Simulation3d simulation(scene, {});
  run(simulation, 120);
  EXPECT_NEAR(simulation.soft_body(0).centre_of_mass().x(), 3, 0.5f);
  const Eigen::Vector3f before = simulation.soft_body(0).linear_momentum();
  run(simulation, 30);
  EXPECT_LT((simulation.soft_body(0).linear_momentum() - before).norm(), 0.01f * before.norm());
}

TEST(Script, WorksOnBodiesOfTwoDimensions) {
  const Scene2d scene = std::get<Scene2d>(
      parse_scene("dimension = 2\n[[soft_body]]\nname = \"b\"\ncell_size = 1\nrows = [\"##\"]\n"
                  "[[impulse]]\ntime = 0\nbody = \"b\"\nvelocity = [1, 2]\n"
                  "[[drag]]\nbody = \"b\"\nbegin = 0\nend = 1\nfrom = [-1, -0.5]\nto = [-1, -0.5]\n",
                  "s.toml"));
  const SoftBody2dPlacement& placement = scene.soft_bodies.at(0);
  ppu::SoftBody2d body(ppu::make_soft_body_model(placement.lattice(), placement.settings),
                       placement.position);
  ScriptPlayer<2> player(scene.script);
  player.act(0, [&](std::size_t) -> ppu::SoftBody2d& { return body; });
  EXPECT_EQ(body.velocities()[0], Eigen::Vector2f(0, 0)) << "the particle that is held where it is";
  EXPECT_EQ(body.velocities()[5], Eigen::Vector2f(1, 2));
}

}  // namespace
}  // namespace softcell::demos
