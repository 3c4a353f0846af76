// softcell demo 2d: soft bodies in a Box2D world.

#include "scene_demo.h"
#include "scene_view_2d.h"
#include "simulation_2d.h"
#include "verbs.h"

namespace softcell::demos {
namespace {

struct Types2d {
  static constexpr int kDimension = 2;
  using Scene = Scene2d;
  using Simulation = Simulation2d;
  using Shown = Shown2d;
  using SceneView = SceneView2d;
  using View = View2d;
  static constexpr int kViews = kViews2d;
};

class Demo2d final : public SceneDemo<Types2d> {
 public:
  Demo2d(const Scene2d& scene, const Log& log, const SimulationOptions& how, const Demo2dOptions& options)
      : SceneDemo(scene, log, how, options.view,
                  {MouseHand(scene.camera, options.size.width, options.size.height)}) {}

  DemoCounts counts() const override {
    return {.soft_bodies = simulation().soft_bodies(),
            .rigid_bodies = simulation().rigid_bodies(),
            .particles = simulation().particles(),
            .vertices = simulation().particles()};
  }
};

}  // namespace

int run_demo_2d(const Demo2dOptions& options) {
  return run_demo(options, "demo 2d", [&](bool all) {
    InputLog<2> log(options);
    Scene2d scene = load_scene_2d(options.scene.value_or(log.scene_name().value_or("man")));
    log.begin(scene);
    return demos_of<Demo2d>(options, log, scene, all, load_scene_2d);
  });
}

}  // namespace softcell::demos
