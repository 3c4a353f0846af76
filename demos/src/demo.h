#pragma once
// What the demos in two and three dimensions have in common for those who run them: a verb, a window.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "options.h"
#include "simulation_options.h"
#include "softcell/ls_sim/statistics.h"
#include "softcell/render/renderer.h"

namespace softcell::demos {

/// How much there is in a scene.
struct DemoCounts {
  std::size_t soft_bodies = 0, rigid_bodies = 0, particles = 0, vertices = 0;
};

/// A scene at work, and how it looks. Used by one thread.
class Demo {
 public:
  virtual ~Demo() = default;

  virtual const std::string& scene_name() const = 0;
  virtual int frames() const = 0;  ///< how long the scene is worth watching without a user
  virtual DemoCounts counts() const = 0;

  /// Simulates a frame of 1/60 s. @throws std::runtime_error  an SPE failed, or a body became NaN.
  virtual FrameTimes step() = 0;
  /// Ends what the SPEs do: statistics and trace are whole then. No step afterwards. @throws as step().
  virtual void stop() = 0;
  virtual std::uint64_t state_hash() const = 0;
  virtual std::vector<ls_sim::SpeStatistics> spe_statistics() const = 0;
  virtual std::uint64_t late_frames() const = 0;

  /// Before the first draw(). The renderer must outlive the last one.
  virtual void make_view(render::Renderer& renderer) = 0;
  /// The frame that is shown. @pre make_view()
  virtual const render::Image& draw() = 0;
};

using MakeDemo = std::function<std::unique_ptr<Demo>(const SimulationOptions&)>;

/// Runs a demo without a window: steps it, writes its pictures, reports what it cost.
/// @param verb  "demo 3d"   @param make  is called once, before threads are started: scenes in Lua fork
/// @return the exit status: 0, 3 when checked kernels have findings, or 130 when interrupted.
/// @throws UsageError  a window is asked for.
int run_demo(const DemoOptions& options, std::string_view verb, const MakeDemo& make);

}  // namespace softcell::demos
