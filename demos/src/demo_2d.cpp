// softcell demo 2d: soft bodies in a Box2D world.

#include <optional>

#include "demo.h"
#include "scene_file/scene_library.h"
#include "scene_view_2d.h"
#include "simulation_2d.h"
#include "verbs.h"

namespace softcell::demos {
namespace {

/// A scene, its simulation and its view.
class Demo2d : public Demo {
 public:
  Demo2d(Scene2d scene, const SimulationOptions& how, const Demo2dOptions& options)
      : scene_(std::move(scene)), simulation_(scene_, how), kind_(options.view) {}

  const std::string& scene_name() const override { return scene_.name; }
  int frames() const override { return scene_.frames; }
  DemoCounts counts() const override {
    return {.soft_bodies = simulation_.soft_bodies(),
            .rigid_bodies = simulation_.rigid_bodies(),
            .particles = simulation_.particles(),
            .vertices = simulation_.particles()};
  }
  FrameTimes step() override { return simulation_.step(); }
  void stop() override { simulation_.stop(); }
  std::uint64_t state_hash() const override { return simulation_.state_hash(); }
  std::vector<ls_sim::SpeStatistics> spe_statistics() const override { return simulation_.spe_statistics(); }
  std::uint64_t late_frames() const override { return 0; }
  void make_view(render::Renderer& renderer) override { view_.emplace(scene_, simulation_, renderer, kind_); }
  const render::Image& draw() override { return view_->draw(); }

 private:
  Scene2d scene_;
  Simulation2d simulation_;
  View2d kind_;
  std::optional<SceneView2d> view_;
};

}  // namespace

int run_demo_2d(const Demo2dOptions& options) {
  return run_demo(options, "demo 2d", [&](const SimulationOptions& how) {
    return std::make_unique<Demo2d>(load_scene_2d(options.scene.value_or("man")), how, options);
  });
}

}  // namespace softcell::demos
