#pragma once
// Steps the bodies of one model on the SPEs: shape matching and damping by the kernel `match`.
//
//     MatchOrchestrator matching(memory, jobs, image, plan, 150);   // 150 bodies of one model
//     matching.positions(b)[i] = ..., matching.velocities(b)[i] = ...
//     matching.step({.pull = alpha / h, .damping = k});
//     ... = matching.velocities(b)[i]
//
// Positions, velocities and rotations live in main memory, where the SPEs work on them.

#include <vector>

#include "ppu/spe_bodies/match_bodies.h"

namespace softcell::ppu {

/// Used by one thread at a time.
class MatchOrchestrator {
 public:
  using Vector = MatchBodies::Vector;

  /// `memory`, `jobs` and `match` must outlive the orchestrator; `match` is the image of the kernel match.
  /// @param bodies_per_job  a job fetches the plan once and steps so many bodies
  /// @throws std::runtime_error  main memory is full.
  MatchOrchestrator(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match,
                    const MatchPlan& plan, std::size_t bodies, std::size_t bodies_per_job = 16);

  std::size_t bodies() const { return bodies_.size(); }
  std::span<Vector> positions(std::size_t body) { return bodies_.positions(body); }    ///< metres
  std::span<Vector> velocities(std::size_t body) { return bodies_.velocities(body); }  ///< m/s
  /// Of the plan's regions, in groups of four: see MatchPlan::region_of().
  std::span<const spu::MatchRotations> rotations(std::size_t body) const { return bodies_.rotations(body); }

  /// One step of all bodies: kick() and wait().
  void step(const MatchSettings& settings);

  /// Starts a step. @pre the one before has been waited for. Nothing may be read or changed before wait()
  /// returns. @throws std::invalid_argument  settings out of their ranges.
  void kick(const MatchSettings& settings);

  /// @throws std::runtime_error  a job failed, or a body has positions or velocities that are no numbers;
  ///         those bodies are as they were before the step.
  void wait();

  /// The largest |axial(R^T A)| of the last step over the sum of |A|'s elements, roughly radians.
  float residual(std::size_t body) const { return bodies_.residual(body); }

  /// Forgets a body's rotations: after a teleport. Its next step starts cold; that is also how a body begins.
  void reset(std::size_t body) { bodies_.reset(body); }

 private:
  JobImage match_;
  MatchBodies bodies_;
  std::vector<std::size_t> all_;  // 0, 1, 2, ...
  std::size_t bodies_per_job_;
  bool in_flight_ = false;
  JobChain chain_;  // last, so that it has ended before what its jobs work on goes
};

}  // namespace softcell::ppu
