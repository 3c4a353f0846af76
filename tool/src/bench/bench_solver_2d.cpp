// Shape matching and damping in two dimensions: the kernel match_2d on one SPE, compared with the PPU's solvers.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench_bodies.h"
#include "benchmarks.h"
#include "kernel_runs/kernel_file.h"
#include "ppu/reference/eigen_solver.h"
#include "ppu/reference/shape_matching.h"
#include "ppu/spe_bodies/match_bodies.h"
#include "softcell/base/assert.h"
#include "softcell/jobs/job_system.h"
#include "spe_waker.h"

namespace softcell::tool {
namespace {

constexpr std::size_t kParticlesAtOnce = 16'000;  // so many that waking the SPE does not count

/// The man of the 2D demo.
ppu::Lattice<2> man132() {
  std::vector<std::string> rows;
  const auto add = [&](int count, const char* row) {
    rows.insert(rows.end(), static_cast<std::size_t>(count), row);
  };
  add(4, "      ####");
  add(1, "       ##");
  add(2, "################");
  add(2, "     ######");
  add(7, "     ##  ##");
  return ppu::lattice_from_cells(ppu::cells_from_rows(rows), kSpacing);
}

/// 32 x 32 particles.
ppu::Lattice<2> block1024() {
  const std::vector<std::string> rows(31, std::string(31, '#'));
  return ppu::lattice_from_cells(ppu::cells_from_rows(rows), kSpacing);
}

struct SolverCase2d {
  SolverCase2d(ppu::Lattice<2> body, int half_width)
      : lattice(std::move(body)),
        plan(std::make_shared<const ppu::MatchingPlan<float, 2>>(lattice, half_width,
                                                                 ppu::particle_masses(lattice, 1000))),
        jobs(memory, {.spes = 1}, job_loop),
        waker(jobs),
        bodies(std::max<std::size_t>(1, kParticlesAtOnce / lattice.particles.size())),
        image(jobs.load(kernel)),
        spes(memory, ppu::MatchPlan2d(lattice, *plan), bodies),
        all(bodies),
        chain(jobs, "match_2d", bodies),
        eigen(plan),
        shared_sums(plan, ppu::SumMethod::kBarPlateCube),
        naive_sums(plan, ppu::SumMethod::kNaive) {
    SC_ASSERT(bodies > 0 && half_width > 0, "{} bodies in regions of half-width {}", bodies, half_width);
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      const Eigen::Vector2f p = lattice.rest_position(i);
      x.push_back({p.x() + 0.2f * p.y() * p.y(), p.y()});  // bent
    }
    SC_ASSERT(x.size() == plan->particles(), "{} places of {} particles", x.size(), plan->particles());
    v.resize(x.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    for (std::size_t b = 0; b < bodies; ++b)
      for (std::size_t i = 0; i < x.size(); ++i) spes.positions(b)[i] = {x[i].x(), x[i].y()};
  }

  void run_spes() {
    for (std::size_t b = 0; b < bodies; ++b) std::ranges::fill(spes.velocities(b), spu::MatchVector2d{});
    chain.clear();
    spes.add_jobs(chain, image, {.pull = kAlpha / kStep, .damping = kDamping}, all, kBodiesPerJob);
    chain.kick();
    chain.wait();
    if (!chain.failures().empty()) throw std::runtime_error(chain.failures().front().message);
  }

  void run_eigen() {
    std::ranges::fill(v, Eigen::Vector2f::Zero());
    SC_ASSERT(v.size() == x.size(), "{} velocities of {} particles", v.size(), x.size());
    eigen.step(x, v, kAlpha, kStep, kDamping);
  }

  void run_ppu(ppu::ShapeMatcher<float, 2>& matcher) {
    std::ranges::fill(v, Eigen::Vector2f::Zero());
    matcher.step_velocities(x, v, kAlpha, kStep, kDamping);
  }

  ppu::Lattice<2> lattice;
  std::shared_ptr<const ppu::MatchingPlan<float, 2>> plan;
  dma::AddressSpace memory;
  ls_sim::KernelImage kernel = load_kernel("match_2d"), job_loop = load_kernel("job_loop");
  ppu::JobSystem jobs;
  SpeWaker waker;
  std::size_t bodies;
  ppu::JobImage image;
  ppu::MatchBodies<2> spes;
  std::vector<std::size_t> all;  // 0, 1, 2, ...
  ppu::JobChain chain;           // after the memory of its jobs, so that it ends before that is freed
  ppu::EigenSolver<2> eigen;
  ppu::ShapeMatcher<float, 2> shared_sums, naive_sums;
  std::vector<Eigen::Vector2f> x, v;
};

void add_solver(std::vector<Benchmark>& all, const std::string& body, ppu::Lattice<2> (*make)(),
                int half_width) {
  const Shared<SolverCase2d> shared(
      [make, half_width] { return std::make_shared<SolverCase2d>(make(), half_width); });
  const auto add = [&](std::string_view solver, auto run, bool on_spes = false) {
    all.push_back({fmt::format("solver2d/{}/w{}/{}", body, half_width, solver), [=] {
                     const auto rig = shared.get();
                     Work work{(on_spes ? rig->bodies : 1) * rig->x.size(), [=] { run(*rig); }};
                     if (on_spes) work.before = [=] { rig->waker.wake(); };
                     return work;
                   }});
  };
  add(
      "spe", [](SolverCase2d& rig) { rig.run_spes(); }, true);
  add("eigen", [](SolverCase2d& rig) { rig.run_eigen(); });
  add("ppu", [](SolverCase2d& rig) { rig.run_ppu(rig.shared_sums); });
  add("naive", [](SolverCase2d& rig) { rig.run_ppu(rig.naive_sums); });
}

}  // namespace

void add_solver_2d_benchmarks(std::vector<Benchmark>& all) {
  for (int w = 1; w <= 4; ++w) {
    add_solver(all, "man132", man132, w);
    add_solver(all, "block1024", block1024, w);
  }
}

}  // namespace softcell::tool
