// softcell demo 3d: soft bodies in a Bullet world.

#include <optional>

#include "demo.h"
#include "input_log.h"
#include "scene_file/scene_library.h"
#include "scene_view.h"
#include "simulation_3d.h"
#include "verbs.h"
#include "window/latest.h"
#include "window/user_input.h"

namespace softcell::demos {
namespace {

std::optional<OwnModel> load_model(const Demo3dOptions& options) {
  if (!options.mesh) return std::nullopt;
  OwnModel model{.mesh = ppu::import_mesh(*options.mesh)};
  const ppu::Bounds box = ppu::bounds(model.mesh);
  const double longest = (box.high - box.low).maxCoeff();
  model.cell_size = static_cast<float>(options.cell.value_or(longest / options.cells));
  ppu::fit(model.mesh, static_cast<float>(longest));  // centred, its size unchanged
  // Refused here, in the model's own units, before the scene scales both: the sentence has the user's
  // numbers.
  ppu::voxelize(model.mesh, model.cell_size);
  return model;
}

/// A scene, its simulation and its view.
class Demo3d : public Demo {
 public:
  Demo3d(Scene scene, InputLog<3> log, const SimulationOptions& how, const Demo3dOptions& options)
      : scene_(std::move(scene)),
        log_(std::move(log)),
        simulation_(scene_, how),
        kind_(options.lattice ? View::kLattice : View::kMesh) {
    input_.set_look({.view = static_cast<int>(kind_)});
    input_.follow(simulation_.gravity(), simulation_.paused());
  }

  const std::string& scene_name() const override { return scene_.name; }
  int frames() const override { return log_.replays() ? static_cast<int>(log_.frames()) : scene_.frames; }
  DemoCounts counts() const override {
    return {.soft_bodies = simulation_.soft_bodies(),
            .rigid_bodies = simulation_.rigid_bodies(),
            .particles = simulation_.particles(),
            .vertices = simulation_.vertices()};
  }
  FrameTimes step() override {
    const auto from_user = input_.next_frame();
    const FrameTimes times = simulation_.step(log_.replays() ? log_.events_at(frame_) : from_user);
    log_.note(frame_++, simulation_.last_events());
    input_.follow(simulation_.gravity(), simulation_.paused());
    return times;
  }
  void stop() override { simulation_.stop(); }
  std::uint64_t state_hash() const override { return simulation_.state_hash(); }
  std::vector<ls_sim::SpeStatistics> spe_statistics() const override { return simulation_.spe_statistics(); }
  std::uint64_t late_frames() const override { return simulation_.late_frames(); }
  void save_recording() override { log_.save(state_hash()); }
  void check_replay() const override { log_.check(); }
  void make_view(render::Renderer& renderer) override { view_.emplace(scene_, simulation_, renderer, kind_); }
  const render::Image& draw() override { return view_->draw(); }

  WindowInput& input() override { return input_; }
  int dimension() const override { return 3; }
  bool paused() const override { return simulation_.paused(); }
  bool replays() const override { return log_.replays(); }
  void publish() override {
    simulation_.show(shown_.next());
    shown_.publish();
  }
  void draw_published(const Look& look) override {
    shown_.update();
    view_->draw(shown_.current(), look);
  }

 private:
  Scene scene_;
  InputLog<3> log_;
  std::int64_t frame_ = 0;
  Simulation3d simulation_;
  View kind_;
  UserInput<3> input_{kViews, {}};
  Latest<Shown3d> shown_;
  std::optional<SceneView> view_;
};

}  // namespace

int run_demo_3d(const Demo3dOptions& options) {
  return run_demo(options, "demo 3d", [&](bool all) {
    const std::optional<OwnModel> model = load_model(options);
    InputLog<3> log(options);
    const std::string usual = model ? "drop" : "arena";
    Scene scene = load_scene_3d(options.scene.value_or(log.scene_name().value_or(usual)), model);
    log.begin(scene);
    std::vector<MakeDemo> scenes;
    const auto add = [&](const Scene& loaded) {
      scenes.push_back([&options, loaded, log](const SimulationOptions& how) {
        return std::make_unique<Demo3d>(loaded, log, how, options);
      });
    };
    add(scene);
    if (!all) return scenes;
    for (const SceneListing& listing : list_scenes()) {
      if (listing.dimension == 3 && listing.name != scene.name) add(load_scene_3d(listing.name));
    }
    return scenes;
  });
}

}  // namespace softcell::demos
