// softcell demo 2d: soft bodies in a Box2D world.

#include <optional>

#include "demo.h"
#include "input_log.h"
#include "scene_file/scene_library.h"
#include "scene_view_2d.h"
#include "simulation_2d.h"
#include "verbs.h"
#include "window/latest.h"
#include "window/user_input.h"

namespace softcell::demos {
namespace {

/// A scene, its simulation and its view.
class Demo2d : public Demo {
 public:
  Demo2d(Scene2d scene, InputLog<2> log, const SimulationOptions& how, const Demo2dOptions& options)
      : scene_(std::move(scene)),
        log_(std::move(log)),
        simulation_(scene_, how),
        kind_(options.view),
        input_(kViews2d, {MouseHand(scene_.camera, options.size.width, options.size.height)}) {
    input_.set_look({.view = static_cast<int>(kind_)});
    input_.follow(simulation_.gravity(), simulation_.paused());
  }

  const std::string& scene_name() const override { return scene_.name; }
  int frames() const override { return log_.replays() ? static_cast<int>(log_.frames()) : scene_.frames; }
  DemoCounts counts() const override {
    return {.soft_bodies = simulation_.soft_bodies(),
            .rigid_bodies = simulation_.rigid_bodies(),
            .particles = simulation_.particles(),
            .vertices = simulation_.particles()};
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
  std::uint64_t late_frames() const override { return 0; }
  void save_recording() override { log_.save(state_hash()); }
  void check_replay() const override { log_.check(); }
  void make_view(render::Renderer& renderer) override { view_.emplace(scene_, simulation_, renderer, kind_); }
  const render::Image& draw() override { return view_->draw(); }

  WindowInput& input() override { return input_; }
  int dimension() const override { return 2; }
  bool paused() const override { return simulation_.paused(); }
  bool replays() const override { return log_.replays(); }
  void publish() override {
    simulation_.show(shown_.next());
    shown_.publish();
  }
  void draw_published(const Look& look) override {
    shown_.update();
    view_->draw(shown_.current(), static_cast<View2d>(look.view));
  }

 private:
  Scene2d scene_;
  InputLog<2> log_;
  std::int64_t frame_ = 0;
  Simulation2d simulation_;
  View2d kind_;
  UserInput<2> input_;
  Latest<Shown2d> shown_;
  std::optional<SceneView2d> view_;
};

}  // namespace

int run_demo_2d(const Demo2dOptions& options) {
  return run_demo(options, "demo 2d", [&](bool all) {
    InputLog<2> log(options);
    Scene2d scene = load_scene_2d(options.scene.value_or(log.scene_name().value_or("man")));
    log.begin(scene);
    std::vector<MakeDemo> scenes;
    const auto add = [&](const Scene2d& loaded) {
      scenes.push_back([&options, loaded, log](const SimulationOptions& how) {
        return std::make_unique<Demo2d>(loaded, log, how, options);
      });
    };
    add(scene);
    if (!all) return scenes;
    for (const SceneListing& listing : list_scenes()) {
      if (listing.dimension == 2 && listing.name != scene.name) add(load_scene_2d(listing.name));
    }
    return scenes;
  });
}

}  // namespace softcell::demos
