// softcell demo 3d: soft bodies in a Bullet world.

#include <optional>

#include "own_model.h"
#include "particle_under.h"
#include "scene_camera.h"
#include "scene_demo.h"
#include "scene_view.h"
#include "simulation_3d.h"
#include "verbs.h"

namespace softcell::demos {
namespace {

struct Types3d {
  static constexpr int kDimension = 3;
  using Scene = demos::Scene;
  using Simulation = Simulation3d;
  using Shown = Shown3d;
  using SceneView = demos::SceneView;
  using View = demos::View;
  static constexpr int kViews = demos::kViews;
};

SimulationOptions skinned_by(Skin skin, SimulationOptions how) {
  how.skin = skin;
  return how;
}

class Demo3d final : public SceneDemo<Types3d> {
 public:
  Demo3d(const Scene& scene, const Log& log, const SimulationOptions& how, const Demo3dOptions& options)
      : SceneDemo(scene, log, skinned_by(options.skin, how), options.view,
                  {.tilt = {},
                   .hand = MouseReach([this](const Look& look) { return eye(look); },
                                      [this](const Ray& ray) { return particle_under(ray, simulation()); },
                                      options.size.width, options.size.height)}) {}

  FrameTimes step() override {
    simulation().note_contacts(static_cast<View>(input().look().view) == View::kContacts);
    return SceneDemo::step();
  }
  DemoCounts counts() const override {
    return {.soft_bodies = simulation().soft_bodies(),
            .rigid_bodies = simulation().rigid_bodies(),
            .particles = simulation().particles(),
            .vertices = simulation().vertices()};
  }

 private:
  render::Camera eye(const Look& look) const { return seen_from(scene(), look, simulation().shown_tilt()); }
};

}  // namespace

int run_demo_3d(const Demo3dOptions& options) {
  check_kept({{"--mesh", options.mesh}}, written_files(options));
  return run_demo(options, "demo 3d", [&](bool all) {
    const std::optional<OwnModel> model = load_own_model(options);
    InputLog<3> log(options);
    const std::string usual = model ? "drop" : "arena";
    Scene scene = load_scene_3d(options.scene.value_or(log.scene_name().value_or(usual)), model);
    log.begin(scene);
    return demos_of<Demo3d>(options, log, scene, all,
                            [](std::string_view name) { return load_scene_3d(name); });
  });
}

}  // namespace softcell::demos
