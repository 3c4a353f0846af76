#pragma once
// What the pictures of a simulation in three dimensions show: one frame is shown while the SPEs skin the next one.

#include <Eigen/Core>
#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ppu/spe_bodies/skin_orchestrator.h"
#include "shown.h"
#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/soft_bodies/contact.h"

namespace softcell::demos {

/// What a picture needs besides the vertices, from the moment at which these were handed to the SPEs.
struct Snapshot3d {
  std::vector<std::vector<Eigen::Vector4f>> particles;               ///< of each soft body
  std::vector<std::shared_ptr<const ppu::SoftBodyModel<3>>> models;  ///< likewise
  std::vector<std::size_t> sources;                                  ///< likewise: see SceneBodies
  std::vector<Eigen::Vector3f> origins;                              ///< of vertices made by the GPU
  // Set by the simulation, see Snapshots3d::next():
  std::vector<Eigen::Matrix4f> box_poses;
  std::vector<ppu::Contact> contacts;
  std::vector<std::array<Eigen::Vector3f, 2>> hands;
  std::vector<ShownRope<3>> ropes;
  Eigen::Matrix3f tilt = Eigen::Matrix3f::Identity();
};

/// One thread uses it.
class Snapshots3d {
 public:
  /// Lets the SPEs make the vertices; without this call, the GPU makes them. All three must outlive this object.
  /// @pre no frame was handed over
  void skin_on_spes(dma::AddressSpace& memory, ppu::JobSystem& jobs, const ls_sim::KernelImage& skin);
  bool skins_on_spes() const { return orchestrator_.has_value(); }

  /// Updates what is drawn to the present bodies and their models. @return whether anything has changed
  bool follow(const ppu::BulletSoftBodies& bodies);
  /// A body was removed; the numbers of bodies after it decrease by one. @pre it was in the bodies of the last follow()
  void remove(std::size_t body);

  /// The frame that is handed over next: set what the simulation sets. @pre no frame is handed over
  Snapshot3d& next();
  /// Copies the bodies of the last follow() into next() and lets the SPEs skin them. @param sources  see SceneBodies  @pre as next()
  void hand_over(std::span<const std::size_t> sources);
  /// Waits for the SPEs. What was handed over, if anything was, is the shown frame from then on.
  /// @throws std::runtime_error  skinning has failed
  void take_over();

  const Snapshot3d& shown() const { return snapshots_[static_cast<std::size_t>(newest_)]; }
  Snapshot3d& shown() { return snapshots_[static_cast<std::size_t>(newest_)]; }
  /// A body's vertices in the shown frame; none, if the GPU makes them. @pre body < shown().particles.size()
  ppu::SkinnedBody skinned(std::size_t body) const;

  // Of the bodies of the last follow():
  std::size_t vertices() const { return vertices_; }
  std::span<const std::span<const Eigen::Vector4f>> positions() const { return positions_; }
  /// Processor time of the PPU in the last hand_over().
  std::chrono::nanoseconds skin_time() const { return skin_time_; }

 private:
  void copy_particles(std::span<const std::size_t> sources);

  std::optional<ppu::SkinOrchestrator> orchestrator_;  // none: the GPU skins
  std::vector<std::shared_ptr<const ppu::SoftBodyModel<3>>> drawn_;
  std::vector<std::span<const Eigen::Vector4f>> positions_;
  std::size_t vertices_ = 0;
  std::chrono::nanoseconds skin_time_{0};

  std::array<Snapshot3d, 2> snapshots_;
  int newest_ = 1;            // the shown snapshot, which belongs to the vertices that the orchestrator shows
  bool handed_over_ = false;  // the other snapshot is the next one to be shown
};

}  // namespace softcell::demos
