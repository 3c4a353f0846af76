#pragma once
// One body that is too large for a local store, in main memory: all SPEs step it together with the kernel `match_tiles`.
//
//     const TilePlan plan(lattice, matching);
//     TiledMemory body(memory, plan);
//     body.positions()[plan.place_of()[i]] = ..., body.velocities()[plan.place_of()[i]] = ...
//     body.begin_step({.pull = alpha / h, .damping = k});
//     for (const spu::TilePass pass : kTilePasses) body.add_jobs(chain, image, pass), chain.sync();
//     chain.kick(), chain.wait();
//     body.end_step();
//     ... = body.velocities()[plan.place_of()[i]]
//
// The result has the same bits as that of MatchBodies on a body that fits.

#include <array>
#include <optional>
#include <span>

#include "match_tiles_job.h"
#include "ppu/plans/tile_plan.h"
#include "ppu/spe_bodies/match_bodies.h"
#include "ppu/spe_bodies/region_rotations.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

/// In the order of a step.
inline constexpr std::array kTilePasses{spu::kTileGather, spu::kTileScatter, spu::kTileTwist, spu::kTileDamp};

/// A body in tiles as it lies in main memory, and the jobs of its step, for the code that runs them.
class TiledMemory {
 public:
  using Vector = MatchBodies<3>::Vector;

  /// Copies the plan. Main memory: about 250 bytes a particle, 55 MB for 200,000.
  /// @throws std::runtime_error  main memory is full.
  TiledMemory(dma::AddressSpace& memory, const TilePlan& plan);

  std::size_t tiles() const { return reports_.size(); }

  /// Positions and velocities by place, see TilePlan::place_of(). Do not change the places between.
  std::span<Vector> positions() { return positions_.span(); }    ///< metres; a step does not change them
  std::span<Vector> velocities() { return velocities_.span(); }  ///< m/s
  dma::EffectiveAddress positions_ea() const { return positions_.ea(); }

  /// Takes the constants of another rest shape. @param plan  the one that the body was made from
  void set_rest(const TilePlan& plan, const MatchingPlan<float, 3>& matching);

  /// The rotations that the next step begins with, valid until end_step(). @param plan  as above
  RegionRotations region_rotations(const TilePlan& plan, const SumPlan& sums);

  /// Call it before the jobs run. @throws std::invalid_argument  settings out of their ranges.
  void begin_step(const MatchSettings& settings);

  /// The descriptor of one job of the current step; none where a tile has nothing to do in that pass.
  std::optional<dma::EffectiveAddress> job(spu::TilePass pass, std::size_t tile) const;

  /// Adds the jobs of one pass of the current step. All jobs of a pass must have ended before one of the next pass begins, in the order of
  /// kTilePasses; several bodies may go through a pass together.
  void add_jobs(JobChain& chain, const JobImage& match_tiles, spu::TilePass pass) const;
  /// The most jobs that a step has.
  std::size_t most_jobs() const { return jobs_.size(); }

  /// Call it when all jobs have ended. @throws std::runtime_error  a position or velocity is not finite; nothing has changed.
  void end_step();

  /// The largest |axial(R^T A)| of the last step over the sum of |A|'s elements, roughly radians.
  float residual() const;

  /// Forgets the rotations, after a teleport: the next step starts cold, as a new body's first step does.
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

}  // namespace softcell::ppu
