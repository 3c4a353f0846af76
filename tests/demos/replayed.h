#pragma once
// The recordings of tests/demos/recordings: what a hand at a mouse, or a scene's script, did to a body.
// Where a change of bits or of the format is intended, `ci/figures` plays the man's once more, and stored_recording_tests the others.

#include <filesystem>
#include <functional>
#include <string>

#include "input/input_log.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"

namespace softcell::demos {

inline std::filesystem::path recording_file(const std::string& name) {
  return std::filesystem::path(SOFTCELL_RECORDINGS_DIR) / (name + ".rec");
}

/// A recording, done again to its end.
template <class Simulation, class Scene, int Dimension>
class ReplayedRun {
 public:
  /// @param name  of the file, without ending  @param each_frame  is called after each
  /// @throws std::runtime_error  it is refused, or ends in another state than it did
  explicit ReplayedRun(const std::string& name,
                       const std::function<void(const ReplayedRun&)>& each_frame = {},
                       const SimulationOptions& options = {})
      : log_({.record = {}, .replay = recording_file(name)}),
        scene_(scene_of(log_)),
        simulation_(scene_, options) {
    for (std::int64_t frame = 0; frame < log_.frames(); ++frame) {
      simulation_.step(log_.events_at(frame));
      log_.record(frame, simulation_.last_events());
      if (each_frame) each_frame(*this);
    }
    log_.save(simulation_.state_hash());
    log_.check();
  }

  const Scene& scene() const { return scene_; }
  const Simulation& simulation() const { return simulation_; }
  Simulation& simulation() { return simulation_; }

 private:
  static Scene scene_of(InputLog<Dimension>& log) {
    Scene scene = [&] {
      if constexpr (Dimension == 2)
        return load_scene_2d(log.scene_name().value());
      else
        return load_scene_3d(log.scene_name().value());
    }();
    log.begin(scene);
    return scene;
  }

  InputLog<Dimension> log_;
  Scene scene_;
  Simulation simulation_;
};

using Replayed = ReplayedRun<Simulation2d, Scene2d, 2>;
using Replayed3d = ReplayedRun<Simulation3d, Scene, 3>;

}  // namespace softcell::demos
