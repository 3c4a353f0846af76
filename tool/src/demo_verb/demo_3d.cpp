// softcell demo 3d: soft bodies in a Bullet world.

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "demo/scene_demo.h"
#include "demo_verbs.h"
#include "run_demo.h"
#include "scene/scene_camera.h"
#include "scene_file/own_model.h"
#include "simulation/simulation_3d.h"
#include "verb/exit_status.h"
#include "view/scene_view.h"

namespace softcell::tool {
namespace {

struct Types3d {
  static constexpr int kDimension = 3;
  using Scene = demos::Scene;
  using Simulation = demos::Simulation3d;
  using Shown = demos::Shown3d;
  using SceneView = demos::SceneView;
  using View = demos::View;
  static constexpr int kViews = demos::kViews;
};

demos::SimulationOptions skinned_by(demos::Skin skin, demos::SimulationOptions how) {
  how.skin = skin;
  return how;
}

class Demo3d final : public demos::SceneDemo<Types3d> {
 public:
  Demo3d(const demos::Scene& scene, const Log& log, const demos::SimulationOptions& how,
         const Demo3dOptions& options)
      : SceneDemo(
            scene, log, skinned_by(options.skin, how), options.view,
            {.tilt = {},
             .hand = demos::MouseReach([this](const demos::Look& look) { return eye(look); },
                                       [this](const demos::Ray& ray) { return simulation().touch(ray); },
                                       options.size.width, options.size.height)}) {}

  demos::FrameTimes step() override {
    simulation().record_contacts(static_cast<demos::View>(input().look().view) == demos::View::kContacts);
    return SceneDemo::step();
  }
  demos::DemoCounts counts() const override {
    return {.soft_bodies = simulation().soft_bodies(),
            .rigid_bodies = simulation().rigid_bodies(),
            .particles = simulation().particles(),
            .vertices = simulation().vertices(),
            .bodies_on_ppu = simulation().bodies_on_ppu()};
  }
  ppu::ContactMethod contacts() const override { return simulation().contacts(); }

 private:
  render::Camera eye(const demos::Look& look) const {
    return demos::seen_from(scene(), look, simulation().shown_tilt());
  }
};

demos::Scene load_with_model(const std::string& name, const std::optional<demos::OwnModel>& model) {
  try {
    return demos::load_scene_3d(name, model);
  } catch (const demos::NoPlaceForModel& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

int run_demo_3d(const Demo3dOptions& options) {
  check_kept({{"--mesh", options.model.mesh}}, written_files(options));
  if (const auto cell = options.model.cell;
      options.model.mesh && cell && !(*cell > 0 && std::isfinite(*cell)))
    throw UsageError(fmt::format("--cell {}: give a length above 0, in the model's units", *cell));
  return run_demo(options, "demo 3d", [&](bool all) {
    const std::optional<demos::OwnModel> model = demos::load_own_model(options.model);
    demos::InputLog<3> log(options);
    const std::string usual = model ? "drop" : "arena";
    demos::Scene scene = load_with_model(options.scene.value_or(log.scene_name().value_or(usual)), model);
    check_scene_kept(scene.files, options);
    log.begin(scene);
    return demos_of<Demo3d>(options, log, scene, all,
                            [](std::string_view name) { return demos::load_scene_3d(name); });
  });
}

}  // namespace softcell::tool
