#pragma once
// Bodies that the kernels match, match_2d and match_tiles step, one chain of jobs a step: for tests.

#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/spe_bodies/match_bodies.h"
#include "ppu/spe_bodies/tiled_memory.h"
#include "softcell/jobs/job_system.h"

namespace softcell::test {

/// Kicks and waits. @throws std::runtime_error  a job failed.
inline void run(ppu::JobChain& chain) {
  chain.kick();
  chain.wait();
  for (const ppu::JobFailure& failure : chain.failures()) throw std::runtime_error(failure.message);
}

/// Bodies of one model, whole.
template <int kDimension>
class SteppedBodies : public ppu::MatchBodies<kDimension> {
 public:
  SteppedBodies(dma::AddressSpace& memory, ppu::JobSystem& jobs, const ls_sim::KernelImage& match,
                const typename ppu::MatchKernel<kDimension>::Plan& plan, std::size_t bodies,
                std::size_t bodies_per_job = 16)
      : ppu::MatchBodies<kDimension>(memory, plan, bodies),
        match_(jobs.load(match)),
        all_(bodies),
        bodies_per_job_(bodies_per_job),
        chain_(jobs, "match", bodies) {
    std::iota(all_.begin(), all_.end(), std::size_t{0});
  }

  /// @throws std::runtime_error  as run(), and for positions or velocities that are not finite.
  void step(const ppu::MatchSettings& settings) {
    chain_.clear();
    this->add_jobs(chain_, match_, settings, all_, bodies_per_job_);
    run(chain_);
    const std::vector<std::size_t> bad = this->take_results();
    if (!bad.empty()) throw std::runtime_error("not finite: body " + std::to_string(bad.front()));
  }

 private:
  ppu::JobImage match_;
  std::vector<std::size_t> all_;  // 0, 1, 2, ...
  std::size_t bodies_per_job_;
  ppu::JobChain chain_;  // last, so that it has ended before what its jobs work on goes
};

/// One body in tiles.
class SteppedTiles : public ppu::TiledMemory {
 public:
  SteppedTiles(dma::AddressSpace& memory, ppu::JobSystem& jobs, const ls_sim::KernelImage& match_tiles,
               const ppu::TilePlan& plan)
      : TiledMemory(memory, plan), image_(jobs.load(match_tiles)), chain_(jobs, "tiles", most_jobs()) {}

  /// @throws std::runtime_error  as run() and TiledMemory::end_step().
  void step(const ppu::MatchSettings& settings) {
    begin_step(settings);
    chain_.clear();
    for (const spu::TilePass pass : ppu::kTilePasses) {
      add_jobs(chain_, image_, pass);
      chain_.sync();
    }
    run(chain_);
    end_step();
  }

 private:
  ppu::JobImage image_;
  ppu::JobChain chain_;  // last, so that it has ended before what its jobs work on goes
};

}  // namespace softcell::test
