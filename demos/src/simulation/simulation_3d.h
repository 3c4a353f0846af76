#pragma once
// A scene at work: the Bullet world, the soft bodies in it, and the SPEs that skin them. No pictures here.

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "input/input_event.h"
#include "ppu/bullet/bullet_world.h"
#include "ppu/spe_bodies/skin_orchestrator.h"
#include "scene/scene.h"
#include "shown.h"
#include "simulation_options.h"

namespace softcell::demos {

/// Used by one thread. step() allocates nothing outside Bullet once the first frames are past.
class Simulation3d {
 public:
  /// @throws std::runtime_error  a body cannot be made, main memory is full, the host cannot run kernels.
  Simulation3d(const Scene& scene, const SimulationOptions& options);
  ~Simulation3d();
  Simulation3d(const Simulation3d&) = delete;
  Simulation3d& operator=(const Simulation3d&) = delete;

  /// Does what the scene's script says and then what `events` say, simulates 1/60 s and hands its skinning to
  /// the SPEs; the frame before becomes the one that is shown. During a pause nothing moves; what an
  /// event puts elsewhere is shown at once.
  /// @throws std::runtime_error  when skinning the frame before failed; the sentence is the fault's.
  FrameTimes step(std::span<const InputEvent<3>> events = {});

  /// Waits for the SPEs, so that the newest frame is shown. @throws as step().
  void finish();

  /// What the last step() did at its beginning: the script's events, then those it was given.
  std::span<const InputEvent<3>> last_events() const;

  std::size_t soft_bodies() const;
  std::size_t particles() const;
  std::size_t vertices() const;  ///< of the meshes
  std::size_t rigid_bodies() const;
  Skin skin() const;  ///< who makes the vertices
  const ppu::SoftBodyModel<3>& model(std::size_t body) const;
  const ppu::SoftBody<3>& soft_body(std::size_t body) const;

  /// 64-bit hash over positions and velocities of all particles as they are now.
  std::uint64_t state_hash() const;

  // The frame that is shown: all of one moment. Before the first step that is the beginning.
  ppu::SkinnedBody shown(std::size_t body) const;  ///< without vertices when the GPU makes them
  std::span<const Eigen::Vector4f> shown_particles(std::size_t body) const;
  std::span<const Eigen::Matrix4f> shown_box_poses() const;  ///< of Scene::boxes, in order
  const Eigen::Matrix3f& shown_tilt() const;                 ///< from the ground's frame to the observer's

  /// Only of frames simulated while note_contacts() was on, and of those of a pause in which no body was put
  /// elsewhere: what it touches there is found with the next simulated frame.
  std::span<const ppu::Contact> shown_contacts() const;
  /// From the next step() on contacts are copied, or not, which is how it begins.
  void note_contacts(bool on);

  /// Copies all of it.
  void show(Shown3d& shown) const;

  // Of the events so far:
  bool paused() const;
  const Eigen::Vector3f& gravity() const;  ///< m/s^2

  /// Waits for the SPEs and ends what runs on them, so that their statistics and the trace are whole. No step
  /// afterwards. @throws as step().
  void stop();
  std::vector<ls_sim::SpeStatistics> spe_statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::demos
