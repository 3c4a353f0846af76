#pragma once
// The recordings of tests/demos/recordings: what a hand at a mouse, or a scene's script, did to the man.
// `ci/figures` plays them once more when the state's bits or the recordings' format change.

#include <filesystem>
#include <functional>
#include <string>

#include "input/input_log.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"

namespace softcell::demos {

/// A recording, done again to its end.
class Replayed {
 public:
  /// @param name  of the file, without ending  @param each_frame  is called after each
  /// @throws std::runtime_error  it is refused, or ends in another state than it did
  explicit Replayed(
      const std::string& name,
      const std::function<void(const Replayed&)>& each_frame = [](const Replayed&) {})
      : log_(files_of(name)), scene_(scene_of(log_)), simulation_(scene_) {
    for (std::int64_t frame = 0; frame < log_.frames(); ++frame) {
      simulation_.step(log_.events_at(frame));
      log_.record(frame, simulation_.last_events());
      each_frame(*this);
    }
    log_.save(simulation_.state_hash());
    log_.check();
  }

  const Scene2d& scene() const { return scene_; }
  const Simulation2d& simulation() const { return simulation_; }
  Simulation2d& simulation() { return simulation_; }

 private:
  static RecordingFiles files_of(const std::string& name) {
    return {.record = {}, .replay = std::filesystem::path(SOFTCELL_RECORDINGS_DIR) / (name + ".rec")};
  }
  static Scene2d scene_of(InputLog<2>& log) {
    Scene2d scene = load_scene_2d(log.scene_name().value());
    log.begin(scene);
    return scene;
  }

  InputLog<2> log_;
  Scene2d scene_;
  Simulation2d simulation_;
};

}  // namespace softcell::demos
