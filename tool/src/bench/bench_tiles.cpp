// Shape matching and damping of one large body: the kernel match_tiles on one SPE.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench_bodies.h"
#include "benchmarks.h"
#include "kernel_runs/kernel_file.h"
#include "ppu/reference/shape_matching.h"
#include "ppu/spe_bodies/tiled_memory.h"
#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr ppu::MatchSettings kSettings{
    .pull = 30, .damping = 0.1f, .least_iterations = 2, .most_iterations = 2};

class LargeBody {
 public:
  LargeBody(const ppu::Lattice<3>& lattice, int half_width)
      : plan_(lattice, ppu::MatchingPlan<float, 3>(lattice, half_width, ppu::particle_masses(lattice, 1000))),
        jobs_(memory_, {.spes = 1}, job_loop_),
        image_(jobs_.load(kernel_)),
        body_(memory_, plan_),
        chain_(jobs_, "tiles", body_.most_jobs()) {
    SC_ASSERT(plan_.place_of().size() == lattice.particles.size(), "places for {} particles of {}",
              plan_.place_of().size(), lattice.particles.size());
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      Eigen::Vector3f p = lattice.rest_position(i);
      p.x() += 0.02f * p.y() * p.y();
      body_.positions()[plan_.place_of()[i]] = {p.x(), p.y(), p.z(), 0};
    }
  }

  void run() {
    std::ranges::fill(body_.velocities(), spu::SkinCorner{});
    body_.begin_step(kSettings);
    chain_.clear();
    for (const spu::TilePass pass : ppu::kTilePasses) {
      body_.add_jobs(chain_, image_, pass);
      chain_.sync();
    }
    work_off();
    body_.end_step();
  }

  /// How six SPEs would share a step: each job is timed alone, then assigned to the SPE that is free first, as the job loops take jobs. A
  /// pass begins when all SPEs have finished the previous one.
  std::string shares() {
    using Milliseconds = std::chrono::duration<double, std::milli>;
    constexpr std::size_t kSpes = dma::kSpeCount;
    std::array<Milliseconds, kSpes> work{};
    Milliseconds all{0}, length{0};
    body_.begin_step(kSettings);
    for (const spu::TilePass pass : ppu::kTilePasses) {
      std::array<Milliseconds, kSpes> busy{};
      for (std::size_t tile = 0; tile < body_.tiles(); ++tile)
        if (const auto argp = body_.job(pass, tile)) *std::ranges::min_element(busy) += time_alone(*argp);
      for (std::size_t spe = 0; spe < kSpes; ++spe) work[spe] += busy[spe];
      for (const Milliseconds& time : busy) all += time;
      length += *std::ranges::max_element(busy);
    }
    SC_ASSERT(length.count() > 0 && length <= all, "six SPEs take {} ms for {} ms of work", length.count(),
              all.count());
    std::string text = fmt::format(
        "a step is {:.2f} ms on one SPE, {:.2f} ms on six that have a core each: {:.2f} times as fast\n",
        all.count(), length.count(), all / length);
    for (std::size_t spe = 0; spe < kSpes; ++spe)
      text += fmt::format("  SPE {}: work {:.2f} ms, wait for the ends of passes {:.2f} ms\n", spe,
                          work[spe].count(), (length - work[spe]).count());
    return text;
  }

 private:
  void work_off() {
    chain_.kick();
    chain_.wait();
    if (!chain_.failures().empty()) throw std::runtime_error(chain_.failures().front().message);
  }

  /// The least time of some runs, because whatever else the host does only adds to it.
  std::chrono::nanoseconds time_alone(dma::EffectiveAddress argp) {
    chain_.clear();
    chain_.add({.image = image_, .argp = argp});
    auto least = std::chrono::nanoseconds::max();
    for (int run = 0; run < 9; ++run) {
      const auto before = jobs_.statistics()[0].busy;
      work_off();
      least = std::min(least, jobs_.statistics()[0].busy - before);
    }
    SC_ASSERT(least.count() >= 0, "a job took {} ns", least.count());
    return least;
  }

  ppu::TilePlan plan_;
  dma::AddressSpace memory_;
  ls_sim::KernelImage job_loop_ = load_kernel("job_loop"), kernel_ = load_kernel("match_tiles");
  ppu::JobSystem jobs_;
  ppu::JobImage image_;
  ppu::TiledMemory body_;
  ppu::JobChain chain_;  // last, so that it ends before the memory of its jobs is freed
};

/// @param particles  along each axis
void add_block(std::vector<Benchmark>& all, const char* name, const Eigen::Vector3i& particles,
               int half_width) {
  all.push_back({fmt::format("solver3d/{}/w{}/spe", name, half_width), [particles, half_width] {
                   const auto body = std::make_shared<LargeBody>(bench_block(particles), half_width);
                   return Work{.items = static_cast<std::size_t>(particles.prod()),
                               .run = [body] { body->run(); },
                               .note = [body] { return body->shares(); }};
                 }});
}

}  // namespace

void add_tiles_benchmarks(std::vector<Benchmark>& all) {
  add_block(all, "big", {144, 96, 15}, 2);
  add_block(all, "bigcube", {60, 60, 60}, 2);
}

}  // namespace softcell::tool
