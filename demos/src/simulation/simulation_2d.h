#pragma once
// The simulation of a scene in two dimensions: the Box2D world, its soft bodies, and the SPEs that step them.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "input/hands.h"
#include "input/input_event.h"
#include "scene/scene_2d.h"
#include "shown.h"
#include "simulation_options.h"
#include "softcell/ls_sim/statistics.h"

namespace softcell::demos {

/// One thread uses it. The state after a number of steps depends on the scene, the events and the solver only.
class Simulation2d {
 public:
  /// The scene must outlive it.
  /// @throws std::runtime_error  a body cannot be made, main memory is full, the host cannot run kernels.
  explicit Simulation2d(const Scene2d& scene, const SimulationOptions& options = {});
  ~Simulation2d();
  Simulation2d(const Simulation2d&) = delete;
  Simulation2d& operator=(const Simulation2d&) = delete;

  /// Applies the events of the scene's script, then `events`, and simulates 1/60 s. During a pause nothing moves.
  /// @throws std::runtime_error  a body has become NaN, or an SPE failed.
  FrameTimes step(std::span<const InputEvent<2>> events = {});

  /// Ends the work of the SPEs, so that statistics and trace are complete. Do not step afterwards. @throws as step().
  void stop();

  /// The events that the last step() applied: the script's, then those of the caller.
  std::span<const InputEvent<2>> last_events() const;

  /// The scene's soft bodies and, after them, the pieces of those that have broken.
  std::size_t soft_bodies() const;
  /// The number of the scene's soft body that a body is, or is a piece of.
  std::size_t source(std::size_t body) const;
  /// The number of soft bodies that the PPU steps: all with Solver::kReference, else those that do not fit into a local store.
  std::size_t bodies_on_ppu() const;
  std::size_t particles() const;
  std::size_t rigid_bodies() const;  ///< that can move
  /// Valid until the next step(), which may reset the world or remove a piece.
  const ppu::SoftBody<2>& soft_body(std::size_t body) const;
  Pose2d rigid_pose(std::size_t body) const;  ///< of Scene2d::rigid_bodies
  /// What a hand takes at a point: Action::kHoldRigid for a rigid body that moves and is there, else Action::kHold for the soft body with
  /// the nearest particle. None: there is no soft body.
  std::optional<InputEvent<2>> touch(const Eigen::Vector2f& point) const;
  /// Whether nothing is in a square or near it: no particle and no box around a rigid body. @param side  metres, above 0
  bool is_free(const Eigen::Vector2f& middle, float side) const;
  bool paused() const;
  ppu::ContactMethod contacts() const;  ///< how soft bodies collide
  float time_scale() const;
  int substeps() const;  ///< per 1/60 s
  std::span<const Hands<2>::Held> held() const;
  const Eigen::Vector2f& gravity() const;  ///< m/s^2

  /// Copies what a picture shows, as it is now.
  void show(Shown2d& shown) const;

  /// The present state, for a scene that begins with it. In it hands hold nothing, and a pause has ended.
  /// @throws std::runtime_error  a soft body has broken
  Beginning<2> moment() const;

  /// 64-bit hash over positions and velocities of all particles.
  std::uint64_t state_hash() const;

  std::vector<ls_sim::SpeStatistics> spe_statistics() const;  ///< empty with the reference solver

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::demos
