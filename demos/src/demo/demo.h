#pragma once
// What the demos in two and three dimensions have in common for those who run them: pictures, a window.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/look.h"
#include "simulation/simulation_options.h"
#include "softcell/ls_sim/statistics.h"
#include "softcell/render/renderer.h"

namespace softcell::demos {

/// How much there is in a scene.
struct DemoCounts {
  std::size_t soft_bodies = 0, rigid_bodies = 0, particles = 0, vertices = 0;
};

class WindowInput;

/// A scene at work, and how it looks. Used by one thread, where nothing else is said.
class Demo {
 public:
  virtual ~Demo() = default;

  virtual const std::string& scene_name() const = 0;
  virtual int frames()
      const = 0;  ///< as many as the replay has, or as the scene is worth watching without a user
  virtual DemoCounts counts() const = 0;

  /// Simulates a frame of 1/60 s.
  /// @throws std::runtime_error  an SPE failed, a body became NaN, or a recording is full.
  virtual FrameTimes step() = 0;
  /// Ends what the SPEs do: statistics and trace are whole then. No step afterwards. @throws as step().
  virtual void stop() = 0;
  virtual std::uint64_t state_hash() const = 0;
  virtual std::vector<ls_sim::SpeStatistics> spe_statistics() const = 0;

  /// Writes the recording of the frames so far, if one is asked for.
  /// @throws std::runtime_error  it cannot be written.
  virtual void save_recording() = 0;
  /// @throws std::runtime_error  a replay has not ended in the state that was recorded.
  virtual void check_replay() const = 0;

  /// Before the first drawing. The renderer must outlive the last one.
  virtual void make_view(render::Renderer& renderer) = 0;
  /// The frame that is shown. @pre make_view()
  virtual const render::Image& draw() = 0;

  // In a window:

  /// What the user does at it happens with the next step(), unless that is a replay's.
  virtual WindowInput& input() = 0;
  virtual int dimension() const = 0;
  virtual bool paused() const = 0;
  virtual bool replays() const = 0;
  /// Copies the frame that is shown for draw_published().
  virtual void publish() = 0;
  /// Draws the newest published frame. May be called by another thread than all others, which may go on;
  /// make_view() by the same, while they wait.
  virtual void draw_published(const Look& look) = 0;
};

/// Sets a scene up that is loaded already.
using MakeDemo = std::function<std::unique_ptr<Demo>(const SimulationOptions&)>;
}  // namespace softcell::demos
