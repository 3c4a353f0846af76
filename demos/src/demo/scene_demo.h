#pragma once
// The common part of the demos of both dimensions: it steps a scene with the events of its user or of a replay, records the events, and
// publishes and draws frames.

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "demo.h"
#include "input/hands.h"
#include "input/input_log.h"
#include "input/user_input.h"
#include "latest.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

/// A scene, its simulation, its log and its view.
/// @tparam Types  names the types of one dimension: kDimension, Scene, Simulation, Shown (what a picture needs),
///                SceneView (what draws it) and View (an enumeration with kViews values).
template <class Types>
class SceneDemo : public Demo {
 public:
  static constexpr int kDimension = Types::kDimension;
  using Scene = typename Types::Scene;
  using Log = InputLog<kDimension>;

  SceneDemo(Scene scene, Log log, const SimulationOptions& how, typename Types::View view,
            const Pointing<kDimension>& pointing)
      : scene_(std::move(scene)),
        log_(std::move(log)),
        simulation_(scene_, how),
        kind_(view),
        input_(Types::kViews, pointing) {
    SC_ASSERT(static_cast<int>(kind_) >= 0 && static_cast<int>(kind_) < Types::kViews, "view {} of {}", kind_,
              Types::kViews);
    input_.set_look({.view = static_cast<int>(kind_)});
    input_.follow(simulation_.gravity(), simulation_.paused());
  }

  const std::string& scene_name() const override { return scene_.name; }
  int frames() const override { return log_.replays() ? static_cast<int>(log_.frames()) : scene_.frames; }
  FrameTimes step() override {
    const auto from_user = input_.next_frame();
    const FrameTimes times = step_simulation(log_.replays() ? log_.events_at(frame_) : from_user);
    input_.follow(simulation_.gravity(), simulation_.paused());
    follow_hand();
    return times;
  }
  std::optional<PickedParticle> picked() const override {
    // The body may have broken since.
    if (!picked_ || picked_->body >= simulation_.soft_bodies() ||
        picked_->particle >= simulation_.soft_body(picked_->body).positions().size())
      return std::nullopt;
    return picked_particle(simulation_.soft_body(picked_->body), static_cast<std::uint32_t>(picked_->body),
                           static_cast<std::uint32_t>(picked_->particle));
  }
  void stop() override { simulation_.stop(); }
  std::uint64_t state_hash() const override { return simulation_.state_hash(); }
  std::vector<ls_sim::SpeStatistics> spe_statistics() const override { return simulation_.spe_statistics(); }
  void save_recording() override { log_.save(state_hash()); }
  void check_replay() const override { log_.check(); }
  void make_view(render::Renderer& renderer) override { view_.emplace(scene_, simulation_, renderer, kind_); }
  const render::Image& draw(float turn) override {
    SC_ASSERT(view_, "draw() before make_view() of scene '{}'", scene_.name);
    if constexpr (kDimension == 3) return view_->draw(turn);
    return view_->draw();
  }

  WindowInput& input() override { return input_; }
  int dimension() const override { return kDimension; }
  bool paused() const override { return simulation_.paused(); }
  bool replays() const override { return log_.replays(); }
  DemoSettings settings() const override {
    const int substeps = simulation_.substeps();
    return {.gravity = simulation_.gravity().norm(),
            .time_scale = simulation_.time_scale(),
            .substeps = substeps,
            .substep = kFrameSeconds / static_cast<float>(substeps)};
  }
  std::vector<BodyMaterial> materials() const override {
    std::vector<BodyMaterial> materials;
    for (std::size_t b = 0; b < scene_.soft_bodies.size(); ++b)
      materials.push_back(
          material_of(scene_.soft_bodies[b].name, simulation_.soft_body(b), settings().substep));
    return materials;
  }
  void publish() override {
    simulation_.show(shown_.next());
    shown_.publish();
  }
  void draw_published(const Look& look) override {
    SC_ASSERT(view_, "draw_published() before make_view() of scene '{}'", scene_.name);
    SC_ASSERT(look.view >= 0 && look.view < Types::kViews, "view {} of {}", look.view, Types::kViews);
    shown_.update();
    view_->draw(shown_.current(), look);
  }

 protected:
  const Scene& scene() const { return scene_; }
  const Look& look() const { return input_.look(); }
  const typename Types::Simulation& simulation() const { return simulation_; }
  typename Types::Simulation& simulation() { return simulation_; }

  /// The present materials, which may differ from those of the scene.
  std::vector<ppu::SoftBodySettings> settings_of_bodies() const {
    std::vector<ppu::SoftBodySettings> all;
    for (std::size_t b = 0; b < scene_.soft_bodies.size(); ++b)
      all.push_back(simulation_.soft_body(b).settings());
    return all;
  }

  /// @throws std::runtime_error  the run is recorded or replayed, and its scene cannot be changed
  void require_changeable() const {
    if (log_.records() || log_.replays())
      throw std::runtime_error(
          "a recording belongs to one scene: during --record and --replay no body can be added, "
          "removed or made of another density, and no other scene opened");
  }

 private:
  struct Bodies {
    const typename Types::Simulation& simulation;
    std::size_t size() const { return simulation.soft_bodies(); }
    const ppu::SoftBody<kDimension>& operator[](std::size_t i) const { return simulation.soft_body(i); }
  };
  void follow_hand() {
    for (const InputEvent<kDimension>& event : simulation_.last_events()) {
      const bool takes = event.action == Action::kGrab || event.action == Action::kHold;
      if (!takes || !is_users_hand(event.hand)) continue;
      if (const auto nearest = Hands<kDimension>::nearest_particle(event, Bodies{simulation_}))
        picked_ = nearest;
    }
  }

  /// Records a frame also if it fails, so that a replay fails in the same frame.
  FrameTimes step_simulation(std::span<const InputEvent<kDimension>> events) {
    FrameTimes times;
    try {
      times = simulation_.step(events);
    } catch (...) {
      log_.record(frame_++, simulation_.last_events());
      throw;
    }
    log_.record(frame_++, simulation_.last_events());
    log_.require_room();
    return times;
  }

  Scene scene_;
  Log log_;
  std::int64_t frame_ = 0;
  typename Types::Simulation simulation_;
  typename Types::View kind_;
  UserInput<kDimension> input_;
  Latest<typename Types::Shown> shown_;
  std::optional<typename Types::SceneView> view_;
  std::optional<typename Hands<kDimension>::Particle> picked_;
};

}  // namespace softcell::demos
