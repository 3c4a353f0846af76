#pragma once
// Steps one body that no local store holds: shape matching and damping by the kernel `match_tiles`, all SPEs
// together.
//
//     const TilePlan plan(lattice, matching);
//     TiledMatch body(memory, jobs, image, plan);
//     body.positions()[plan.place_of()[i]] = ..., body.velocities()[plan.place_of()[i]] = ...
//     body.step({.pull = alpha / h, .damping = k});
//     ... = body.velocities()[plan.place_of()[i]]
//
// The same bits as MatchOrchestrator's on a body that fits.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "match_tiles_job.h"
#include "ppu/plans/tile_plan.h"
#include "ppu/spe_bodies/match_orchestrator.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

/// In the order of a step.
inline constexpr std::array kTilePasses{spu::kTileGather, spu::kTileScatter, spu::kTileTwist, spu::kTileDamp};

/// A body in tiles as it lies in main memory, and the jobs of its step, for whoever runs them.
class TiledMemory {
 public:
  using Vector = MatchOrchestrator::Vector;

  /// The plan is copied. Main memory: about 250 bytes a particle, 55 MB for 200,000.
  /// @throws std::runtime_error  main memory is full.
  TiledMemory(dma::AddressSpace& memory, const TilePlan& plan);

  std::size_t tiles() const { return reports_.size(); }
  std::span<Vector> positions() { return positions_.span(); }
  std::span<Vector> velocities() { return velocities_.span(); }

  /// Before the jobs run. @throws std::invalid_argument  settings out of their ranges.
  void begin_step(const MatchSettings& settings);

  /// The descriptor of one job of the step begun; none where a tile has nothing to do in that pass.
  std::optional<dma::EffectiveAddress> job(spu::TilePass pass, std::size_t tile) const;

  /// The jobs of one pass of the step begun. All of a pass, in the order of kTilePasses, must have ended
  /// before one of the next begins; bodies may go through a pass together.
  void add_jobs(JobChain& chain, const JobImage& match_tiles, spu::TilePass pass) const;
  /// The most jobs that a step has.
  std::size_t most_jobs() const { return jobs_.size(); }

  /// When all have ended. @throws std::runtime_error  positions or velocities are no numbers; nothing has
  /// changed.
  void end_step();
  /// As TiledMatch.
  float residual() const;
  void reset();

 private:
  dma::Buffer<spu::TiledBody> body_;
  dma::Buffer<std::byte> lists_;
  dma::Buffer<spu::TileSlice> slices_;
  dma::Buffer<spu::TileRest> rest_;
  dma::Buffer<spu::TileWeights> weights_;
  dma::Buffer<spu::MatchRegions> regions_;
  dma::Buffer<Vector> positions_, velocities_;
  dma::Buffer<spu::TilePulled> pulled_;
  dma::Buffer<spu::MatchRotations> rotations_, next_rotations_;
  dma::Buffer<std::byte> motions_;
  dma::Buffer<spu::TileMomenta> momenta_;
  dma::Buffer<spu::TileReport> reports_;
  dma::Buffer<spu::TileJob> jobs_;  // by pass, then by tile
};

/// Used by one thread at a time.
class TiledMatch {
 public:
  using Vector = TiledMemory::Vector;

  /// `memory`, `jobs` and `match_tiles` must outlive the object; `match_tiles` is the image of that kernel.
  /// @throws std::runtime_error  main memory is full.
  TiledMatch(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& match_tiles,
             const TilePlan& plan);

  std::size_t tiles() const { return memory_.tiles(); }

  /// By place, see TilePlan::place_of(). Leave the places between as they are.
  std::span<Vector> positions() { return memory_.positions(); }    ///< metres; the step does not change them
  std::span<Vector> velocities() { return memory_.velocities(); }  ///< m/s

  /// One step: kick() and wait().
  void step(const MatchSettings& settings);

  /// Starts a step. @pre the one before has been waited for. Nothing may be read or changed before wait()
  /// returns.
  /// @throws std::invalid_argument  settings out of their ranges.
  void kick(const MatchSettings& settings);

  /// @throws std::runtime_error  a job failed, or there are positions or velocities that are no numbers; the
  ///         body is as it was before the step.
  void wait();

  /// The largest |axial(R^T A)| of the last step over the sum of |A|'s elements, roughly radians.
  float residual() const { return memory_.residual(); }

  /// Forgets the rotations: after a teleport. The next step starts cold; that is also how a body begins.
  void reset() { memory_.reset(); }

 private:
  JobImage image_;
  TiledMemory memory_;
  bool in_flight_ = false;
  JobChain chain_;  ///< last, so that it has ended before what its jobs work on goes
};

}  // namespace softcell::ppu
