// softcell demo 2d: soft bodies in a Box2D world.

#include "demo/scene_demo.h"
#include "demo_verbs.h"
#include "run_demo.h"
#include "simulation/simulation_2d.h"
#include "view/scene_view_2d.h"

namespace softcell::tool {
namespace {

struct Types2d {
  static constexpr int kDimension = 2;
  using Scene = demos::Scene2d;
  using Simulation = demos::Simulation2d;
  using Shown = demos::Shown2d;
  using SceneView = demos::SceneView2d;
  using View = demos::View2d;
  static constexpr int kViews = demos::kViews2d;
};

class Demo2d final : public demos::SceneDemo<Types2d> {
 public:
  Demo2d(const demos::Scene2d& scene, const Log& log, const demos::SimulationOptions& how,
         const Demo2dOptions& options)
      : SceneDemo(
            scene, log, how, options.view,
            {demos::MouseHand(
                scene.camera, [this](const Eigen::Vector2f& point) { return simulation().touch(point); },
                options.size.width, options.size.height)}) {}

  demos::DemoCounts counts() const override {
    return {.soft_bodies = simulation().soft_bodies(),
            .rigid_bodies = simulation().rigid_bodies(),
            .particles = simulation().particles(),
            .vertices = simulation().particles(),
            .bodies_on_ppu = simulation().bodies_on_ppu()};
  }
  ppu::ContactMethod contacts() const override { return ppu::ContactMethod::kSpheres; }
};

}  // namespace

int run_demo_2d(const Demo2dOptions& options) {
  return run_demo(options, "demo 2d", [&](bool all) {
    demos::InputLog<2> log(options);
    demos::Scene2d scene = demos::load_scene_2d(options.scene.value_or(log.scene_name().value_or("man")));
    check_scene_kept(scene.files, options);
    log.begin(scene);
    return demos_of<Demo2d>(options, log, scene, all, demos::load_scene_2d);
  });
}

}  // namespace softcell::tool
