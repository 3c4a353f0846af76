#pragma once
// The interface that the demos in two and three dimensions share, for headless runs and for windows.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/look.h"
#include "simulation/body_material.h"
#include "simulation/picked.h"
#include "simulation/simulation_options.h"
#include "softcell/ls_sim/statistics.h"
#include "softcell/render/renderer.h"

namespace softcell::demos {

/// The settings of a run that the user may change.
struct DemoSettings {
  float gravity = 0;  ///< m/s^2, strength
  float time_scale = 1;
  int substeps = 1;   ///< per 1/60 s
  float substep = 0;  ///< seconds per substep
};

/// The size of a scene.
struct DemoCounts {
  std::size_t soft_bodies = 0, rigid_bodies = 0, particles = 0, vertices = 0;
  std::size_t bodies_on_ppu = 0;  ///< soft bodies that the PPU steps
};

/// A scene file of the user.
struct OwnScene {
  std::filesystem::path file;
  std::string title;
};

class WindowInput;

/// A change that a user makes to a scene.
struct SceneChange {
  enum class Kind {
    kFile,    ///< adds a soft body made of `file`, at (x, y)
    kShape,   ///< adds a soft body of shape `name` (change_scene.h) at (x, y)
    kRemove,  ///< removes soft body `body`
    kDensity  ///< gives soft body `body` the density `number`; kEveryBody: all soft bodies
  };
  Kind kind = Kind::kFile;
  std::filesystem::path file = {};
  std::string name = {};
  std::uint32_t body = 0;
  float number = 0;           ///< a density, or alpha of a new body
  int x = 0, y = 0;           ///< a point of the window, in the units of SDL's mouse
  int width = 1, height = 1;  ///< of the window, in the same units
};

/// A scene, its simulation and its view. One thread uses it, except where stated.
class Demo {
 public:
  virtual ~Demo() = default;

  virtual const std::string& scene_name() const = 0;
  /// Frames of the replay, or the number that the scene suggests for a run without a user.
  virtual int frames() const = 0;
  virtual DemoCounts counts() const = 0;
  virtual ppu::ContactMethod contacts() const = 0;

  /// Simulates a frame of 1/60 s.
  /// @throws std::runtime_error  an SPE failed, a body became NaN, or a recording is full.
  virtual FrameTimes step() = 0;
  /// Ends the work of the SPEs, so that statistics and trace are complete. Do not step afterwards. @throws as step().
  virtual void stop() = 0;
  virtual std::uint64_t state_hash() const = 0;
  virtual std::vector<ls_sim::SpeStatistics> spe_statistics() const = 0;

  /// Writes the recording of the frames so far, if one is asked for.
  /// @throws std::runtime_error  it cannot be written.
  virtual void save_recording() = 0;
  /// @throws std::runtime_error  a replay has not ended in the state that was recorded.
  virtual void check_replay() const = 0;

  /// Writes a scene file that begins with the present state, and a state file beside it.
  /// @param file  ends in .toml; none: a free name beside the scene, or in the present folder
  /// @return its path
  /// @throws std::runtime_error  it cannot be saved there; nothing is written then.
  virtual std::filesystem::path save_scene(const std::optional<std::filesystem::path>& file) const = 0;

  /// Call it before the first drawing. The renderer must outlive the last drawing.
  virtual void make_view(render::Renderer& renderer) = 0;
  /// Draws the shown frame; in three dimensions the camera is turned about the point it looks at. @pre make_view()
  /// @param turn  radians, counter-clockwise from above
  virtual const render::Image& draw(float turn = 0) = 0;

  // In a window:

  /// The user's input. It takes effect in the next step(), except in a replay.
  virtual WindowInput& input() = 0;
  virtual int dimension() const = 0;
  virtual bool paused() const = 0;
  virtual bool replays() const = 0;
  virtual DemoSettings settings() const = 0;
  virtual std::vector<BodyMaterial> materials() const = 0;  ///< of the soft bodies, in order
  /// The particle nearest to the point where the user last took hold of a soft body, as it is now. None: the user has not taken hold of any
  /// yet.
  virtual std::optional<PickedParticle> picked() const = 0;
  /// The contact that the user clicked last while contacts were shown, as it is now. None: the user has clicked no contact.
  virtual std::optional<PickedContact> picked_contact() const { return std::nullopt; }
  /// The shapes that a user may add.
  virtual std::span<const std::string_view> shapes() const = 0;
  /// A new demo of the same scene with this change, at the same moment. This demo stays as it is.
  /// @throws std::runtime_error  the scene cannot be changed in this way; one sentence.
  virtual std::unique_ptr<Demo> changed(const SceneChange& change, const SimulationOptions& how) const = 0;
  /// A new demo of a scene of the user. @throws std::runtime_error  it cannot be opened; one sentence.
  virtual std::unique_ptr<Demo> opened(const std::filesystem::path& scene_file,
                                       const SimulationOptions& how) const = 0;
  /// The TOML scene files of this dimension in the present folder, sorted by name. Scenes in Lua cannot be opened and are left out.
  virtual std::vector<OwnScene> own_scenes() const = 0;
  /// Copies the present frame, for draw_published().
  virtual void publish() = 0;
  /// Draws the newest published frame. A second thread may call this while the first one steps the demo. That thread must also have called
  /// make_view(), while the first one waited.
  virtual void draw_published(const Look& look) = 0;
};

/// Sets up a scene that is already loaded.
using MakeDemo = std::function<std::unique_ptr<Demo>(const SimulationOptions&)>;

struct NamedDemo {
  std::string name, title;
  MakeDemo make;
};

}  // namespace softcell::demos
