#pragma once
// The simulation of a scene in three dimensions: the Bullet world, its soft bodies, and the SPEs that step and
// skin them.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "input/input_event.h"
#include "ppu/bullet/bullet_world.h"
#include "ppu/spe_bodies/skin_orchestrator.h"
#include "scene/scene.h"
#include "scene/scene_camera.h"
#include "shown.h"
#include "simulation_options.h"

namespace softcell::demos {

/// One thread uses it. After the first frames, step() allocates nothing outside Bullet.
class Simulation3d {
 public:
  /// @throws std::runtime_error  a body cannot be made, main memory is full, the host cannot run kernels, or the scene begins with the
  /// state of another one.
  Simulation3d(const Scene& scene, const SimulationOptions& options);
  ~Simulation3d();
  Simulation3d(const Simulation3d&) = delete;
  Simulation3d& operator=(const Simulation3d&) = delete;

  /// Applies the events of the scene's script, then `events`, simulates 1/60 s and lets the SPEs start to skin the new frame; the previous
  /// frame becomes the shown one. During a pause nothing moves, except that bodies which an event puts elsewhere are shown there at once.
  /// @throws std::runtime_error  skinning the previous frame has failed; the message is that of the fault.
  FrameTimes step(std::span<const InputEvent<3>> events = {});

  /// Waits for the SPEs, so that the newest frame becomes the shown one. @throws as step().
  void finish();

  /// What a hand takes at the end of a ray in the present state: Action::kHold for a soft body or Action::kHoldRigid for a rigid body that
  /// moves, whichever the ray meets first. None: it meets neither, or an opaque thing that does not move comes first.
  std::optional<InputEvent<3>> touch(const Ray& ray) const;

  /// The first point of a ray on a soft body, or on a rigid body that is not transparent. None: the ray meets no such body.
  std::optional<Eigen::Vector3f> seen_along(const Ray& ray) const;

  /// Whether no body is in a box, or nearer to it than one cell of that body. @param box  metres  @pre low < high, finite
  bool is_free(const ppu::Bounds<3>& box) const;

  /// The events that the last step() applied: the script's, then those of the caller.
  std::span<const InputEvent<3>> last_events() const;

  /// The scene's soft bodies and, after them, the pieces of those that have broken.
  std::size_t soft_bodies() const;
  /// The number of the scene's soft body that a body is, or is a piece of.
  std::size_t source(std::size_t body) const;
  /// The number of soft bodies that the PPU steps: all with Solver::kReference, else those that do not fit into a local store.
  std::size_t bodies_on_ppu() const;
  ppu::ContactMethod contacts() const;  ///< how soft bodies collide
  std::size_t particles() const;
  std::size_t vertices() const;  ///< of the meshes
  std::size_t rigid_bodies() const;
  Skin skin() const;  ///< who makes the vertices
  const ppu::SoftBodyModel<3>& model(std::size_t body) const;
  const ppu::SoftBody<3>& soft_body(std::size_t body) const;

  /// The present state, for a scene that begins with it. In it hands hold nothing, and a pause has ended.
  /// @throws std::runtime_error  a soft body has broken
  Beginning<3> moment() const;

  /// 64-bit hash over the present positions and velocities of all particles.
  std::uint64_t state_hash() const;

  // The shown frame, all of it from one moment. Before the first step it is the beginning.
  std::size_t shown_bodies() const;                ///< those of soft_bodies() that existed then
  ppu::SkinnedBody shown(std::size_t body) const;  ///< has no vertices when the GPU makes them
  std::span<const Eigen::Vector4f> shown_particles(std::size_t body) const;
  std::span<const Eigen::Matrix4f> shown_box_poses() const;  ///< of Scene::boxes, then of Scene::rigid_bodies
  const Eigen::Matrix3f& shown_tilt() const;                 ///< from the ground's frame to the observer's

  /// Contacts of the shown frame, if record_contacts() was on when it was simulated. In a pause they are empty after a body was put
  /// elsewhere, because Bullet finds contacts only when it steps.
  std::span<const ppu::Contact> shown_contacts() const;
  /// The name of a contact's body for the user: the scene's name for it, "a piece of" that, or "the floor".
  std::string name_of(const ppu::Contact::Body& body) const;
  /// Whether contacts are copied from the next step() on; off at the start.
  void record_contacts(bool on);

  /// Copies the shown frame.
  void show(Shown3d& shown) const;

  // Set by the events so far:
  bool paused() const;
  float time_scale() const;
  int substeps() const;                    ///< per 1/60 s
  const Eigen::Vector3f& gravity() const;  ///< m/s^2

  /// Waits for the SPEs and ends their job loops, so that statistics and trace are complete. Do not step afterwards. @throws as step().
  void stop();
  std::vector<ls_sim::SpeStatistics> spe_statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::demos
