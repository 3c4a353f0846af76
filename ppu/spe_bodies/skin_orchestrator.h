#pragma once
// Queues the skinning of all soft bodies for the SPEs, double-buffered and one frame late.
//
//   PPU    step 0 | kick 0 | step 1 | kick 1, show 0 | step 2 | kick 2, show 1 | ...
//   SPEs           [ skin 0        ] [ skin 1               ] [ skin 2 ...
//
// Positions, job descriptors and vertices exist twice in main memory: the SPEs work on one half while the PPU
// shows the other.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "ppu/lattice/embedding.h"
#include "skin_job.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

/// One body's vertices of the last frame that is complete.
struct SkinnedBody {
  /// Relative to `origin`, one per output slot of the embedding.
  std::span<const spu::SkinnedVertex> vertices;
  Eigen::Vector3f origin{0, 0, 0};  ///< world position, metres
};

/// The point that skinned vertices are relative to. It lies below all particles, by a margin that is not tiny compared with the body, so
/// that each relative coordinate is a normal half float with an error far below its unit in the last place. @pre at least one position
Eigen::Vector3f skin_origin(std::span<const Eigen::Vector4f> positions);

/// Used by the PPU thread alone.
class SkinOrchestrator {
 public:
  /// All three must outlive the orchestrator. `skin` is the image of the kernel skin.
  SkinOrchestrator(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& skin);
  ~SkinOrchestrator();
  SkinOrchestrator(const SkinOrchestrator&) = delete;
  SkinOrchestrator& operator=(const SkinOrchestrator&) = delete;

  /// Adds a body; numbers count from 0. Copies the embedding's groups into main memory, once for all bodies that share the embedding.
  /// @throws std::runtime_error  main memory is full.
  std::size_t add(std::shared_ptr<const Embedding> embedding, std::size_t particles);

  /// Waits for the frame under way and gives a body that has broken another embedding. It has no vertices before its next frame.
  /// @pre the body was added. @throws std::runtime_error  as add() and kick()
  void replace(std::size_t body, std::shared_ptr<const Embedding> embedding, std::size_t particles);

  /// Waits for the frame under way and removes a body; the numbers of bodies behind it decrease by one.
  /// @pre the body was added. @throws std::runtime_error  as kick(); the body is removed nevertheless.
  void remove(std::size_t body);

  /// Starts skinning one frame: copies each body's particle positions (in order of add()) and queues jobs for the bodies that have moved
  /// since the frame before last. Never waits.
  /// @return false, with nothing done, if the SPEs have not finished the previous frame.
  /// @throws std::runtime_error  a job of the previous frame failed: one sentence per fault.
  bool kick(std::span<const std::span<const Eigen::Vector4f>> positions);

  /// Waits for the frame under way and makes it the one that is shown, for runs whose pictures must not depend on the speed of the host.
  /// @return false if no frame was under way. @throws std::runtime_error as kick().
  bool drain();

  /// The newest complete frame; empty vertices before the body's first one. @pre the body was added
  SkinnedBody shown(std::size_t body) const;

 private:
  struct Model;  // an embedding in main memory
  struct Body;   // a body's two halves

  std::unique_ptr<Body> make_body(std::shared_ptr<const Embedding> embedding, std::size_t particles);
  void forget_unused(const Model& model);
  JobChain* chain_under_way();
  bool collect();
  bool write_half(Body& body, std::span<const Eigen::Vector4f> positions);
  void choose_jobs();
  void forget_jobs();

  dma::AddressSpace& memory_;
  JobImage skin_;
  std::vector<std::unique_ptr<Model>> models_;
  std::vector<std::unique_ptr<Body>> bodies_;
  std::size_t jobs_per_frame_ = 0;
  std::vector<bool> moved_;  // of each body: this frame makes its vertices
  bool in_flight_ = false;
  int working_ = 0;  // the half that the SPEs write, or wrote last
  int shown_ = -1;   // the half that is complete
  /// For each half and body: the half's chain has jobs for it. From frame to frame only the addresses in the jobs change, until other
  /// bodies move than before.
  std::array<std::vector<bool>, 2> skins_;
  std::array<JobChain, 2> chains_;  // last member: chains end before their jobs' memory is freed
};

}  // namespace softcell::ppu
