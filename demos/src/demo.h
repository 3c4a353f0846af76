#pragma once
// What the demos in two and three dimensions have in common for those who run them: a verb, a window.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "distinct_files.h"
#include "options.h"
#include "simulation_options.h"
#include "softcell/ls_sim/statistics.h"
#include "softcell/render/renderer.h"
#include "window/look.h"

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

/// The files that the options ask for, pictures in folders aside.
std::vector<NamedFile> written_files(const DemoOptions& options);

/// Does the work and saves the recording of its frames, also when it fails, a frame that failed included:
/// that is the run that one wants to see again. What goes wrong with saving is only printed then: the work's
/// error is what ends the run.
void run_recorded(Demo& demo, const std::function<void()>& work);

/// Sets a scene up that is loaded already.
using MakeDemo = std::function<std::unique_ptr<Demo>(const SimulationOptions&)>;
/// Loads the scene that the options ask for; with `all` those of the same dimension that come with softcell,
/// too. The first is the one to begin with.
using LoadScenes = std::function<std::vector<MakeDemo>(bool all)>;

/// Runs a demo, in a window or without; steps it, writes its pictures, reports what it cost.
/// @param verb  "demo 3d"   @param load  is called once, before threads are started: scenes in Lua fork
/// @return the exit status: 0, 3 when checked kernels have findings, or 130 when interrupted.
/// @throws UsageError  files are asked for that a window does not write, a video that is no MP4, or a file in
///                     the place of another that is written or read.
int run_demo(const DemoOptions& options, std::string_view verb, const LoadScenes& load);

}  // namespace softcell::demos
