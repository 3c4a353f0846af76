// Shape matching and damping of one large body: the kernel match_tiles on one SPE.

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "benchmarks.h"
#include "kernel_samples.h"
#include "softcell/ppu/shape_matching.h"
#include "softcell/ppu/tiled_match.h"

namespace softcell::demos {
namespace {

struct LargeBody {
  LargeBody(const ppu::Lattice& lattice, int half_width)
      : plan(lattice, ppu::MatchingPlan<float>(lattice, half_width, ppu::particle_masses(lattice, 1000))),
        jobs(memory, {.spes = 1}, job_loop),
        spes(memory, jobs, kernel, plan) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      Eigen::Vector3f p = lattice.rest_position(i);
      p.x() += 0.02f * p.y() * p.y();
      spes.positions()[plan.place_of()[i]] = {p.x(), p.y(), p.z(), 0};
    }
  }

  void run() {
    std::ranges::fill(spes.velocities(), spu::SkinCorner{});
    spes.step({.pull = 30, .damping = 0.1f, .least_iterations = 2, .most_iterations = 2});
  }

  ppu::TilePlan plan;
  dma::AddressSpace memory;
  ls_sim::KernelImage job_loop = load_kernel("job_loop"), kernel = load_kernel("match_tiles");
  ppu::JobSystem jobs;
  ppu::TiledMatch spes;
};

/// @param particles  along each axis
void add_block(std::vector<Benchmark>& all, const char* name, const Eigen::Vector3i& particles,
               int half_width) {
  all.push_back({fmt::format("solver3d/{}/w{}/spe", name, half_width), [particles, half_width] {
                   std::vector<Eigen::Vector3i> cells;
                   for (int x = 0; x + 1 < particles.x(); ++x)
                     for (int y = 0; y + 1 < particles.y(); ++y)
                       for (int z = 0; z + 1 < particles.z(); ++z) cells.emplace_back(x, y, z);
                   const Eigen::Vector3f origin =
                       -0.05f * (particles.cast<float>() - Eigen::Vector3f::Ones());
                   const auto body =
                       std::make_shared<LargeBody>(ppu::lattice_from_cells(cells, 0.1f, origin), half_width);
                   return Work{static_cast<std::size_t>(particles.prod()), [body] { body->run(); }};
                 }});
}

}  // namespace

void add_tiles_benchmarks(std::vector<Benchmark>& all) {
  add_block(all, "big", {144, 96, 15}, 2);
  add_block(all, "bigcube", {60, 60, 60}, 2);
}

}  // namespace softcell::demos
