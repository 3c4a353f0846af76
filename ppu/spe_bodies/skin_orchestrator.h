#pragma once
// Queues the skinning of all soft bodies for the SPEs, double-buffered and one frame late.
//
//   PPU    step 0 | kick 0 | step 1 | kick 1, show 0 | step 2 | kick 2, show 1 | ...
//   SPEs           [ skin 0        ] [ skin 1               ] [ skin 2 ...
//
// Positions, job descriptors and vertices exist twice in main memory: the SPEs work on one half while the PPU
// shows the other.

#include <array>
#include <chrono>
#include <cstdint>
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

/// What skinned vertices are relative to: a point below all particles by a margin that is not tiny against
/// the body, so that every relative coordinate is a normal half float with an error far below its unit in the
/// last place. @pre at least one position
Eigen::Vector3f skin_origin(std::span<const Eigen::Vector4f> positions);

/// Used by the PPU thread alone.
class SkinOrchestrator {
 public:
  /// All three must outlive the orchestrator. `skin` is the image of the kernel skin.
  SkinOrchestrator(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& skin);
  ~SkinOrchestrator();
  SkinOrchestrator(const SkinOrchestrator&) = delete;
  SkinOrchestrator& operator=(const SkinOrchestrator&) = delete;

  /// Adds a body; its number counts from 0. The embedding's groups are copied into main memory, once for all
  /// bodies that share the embedding. @throws std::runtime_error  when main memory is full.
  std::size_t add(std::shared_ptr<const Embedding> embedding, std::size_t particles);

  /// Waits for the frame under way and gives a body, which has broken, another embedding. It has no vertices before its next frame.
  /// @pre the body was added. @throws std::runtime_error  as add() and kick()
  void replace(std::size_t body, std::shared_ptr<const Embedding> embedding, std::size_t particles);

  /// Waits for the frame under way and takes a body out; those behind it count one less from now on.
  /// @pre the body was added. @throws std::runtime_error  as kick(); the body is taken out all the same.
  void remove(std::size_t body);

  /// Starts skinning one frame: copies each body's particle positions (in order of add()) and queues the
  /// jobs of those that have moved since the frame before last. Never waits.
  /// @return false, with nothing done, when the SPEs have not finished the frame before.
  /// @throws std::runtime_error  when a job of the frame before failed: one sentence per fault.
  bool kick(std::span<const std::span<const Eigen::Vector4f>> positions);

  /// Waits for the frame under way and makes it the one that is shown: for runs whose pictures must not
  /// depend on the speed of the host. @return false when there was none under way. @throws std::runtime_error
  /// as kick().
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
  std::vector<bool> moved_;  // of each body: its vertices are made in this frame
  bool in_flight_ = false;
  int working_ = 0;  // the half that the SPEs write, or wrote last
  int shown_ = -1;   // the half that is complete
  /// Of each half, for each body: its jobs are in the half's chain. From frame to frame they only change what they point to, until
  /// other bodies move than before.
  std::array<std::vector<bool>, 2> skins_;
  std::array<JobChain, 2> chains_;  // last: ended before what their jobs work on goes
};

}  // namespace softcell::ppu
