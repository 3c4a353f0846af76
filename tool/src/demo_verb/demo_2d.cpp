// softcell demo 2d: soft bodies in a Box2D world.

#include <optional>
#include <string>
#include <string_view>

#include "demo/scene_demo.h"
#include "demo_verbs.h"
#include "run_demo.h"
#include "scene_file/picture_cells.h"
#include "simulation/simulation_2d.h"
#include "verb/exit_status.h"
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

demos::Scene2d load_with_picture(const std::string& name, const std::optional<demos::OwnPicture>& picture) {
  try {
    return demos::load_scene_2d(name, picture);
  } catch (const demos::NoPlaceForModel& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

int run_demo_2d(const Demo2dOptions& options) {
  check_kept({{"--image", options.image}}, written_files(options));
  return run_demo(options, "demo 2d", [&](bool all) {
    std::optional<demos::OwnPicture> picture;
    if (options.image) picture = {.image = demos::load_picture(*options.image), .cells = options.cells};
    demos::InputLog<2> log(options);
    const std::string usual = picture ? "picture" : "man";
    demos::Scene2d scene =
        load_with_picture(options.scene.value_or(log.scene_name().value_or(usual)), picture);
    check_scene_kept(scene.files, options);
    log.begin(scene);
    return demos_of<Demo2d>(options, log, scene, all,
                            [](std::string_view name) { return demos::load_scene_2d(name); });
  });
}

}  // namespace softcell::tool
