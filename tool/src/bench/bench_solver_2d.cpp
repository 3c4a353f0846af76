// Shape matching and damping in two dimensions: the kernel match_2d on one SPE beside the PPU's solver.

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "benchmarks.h"
#include "ppu/reference/eigen_solver.h"
#include "ppu/reference/shape_matching_2d.h"
#include "ppu/spe_bodies/match_orchestrator_2d.h"
#include "softcell/jobs/job_system.h"
#include "spe_waker.h"
#include "spu/kernel_file.h"

namespace softcell::tool {
namespace {

constexpr float kSpacing = 0.1f, kAlpha = 0.5f, kStep = 1.0f / 60, kDamping = 0.1f;
constexpr std::size_t kParticlesAtOnce = 16'000;  // so many in one measurement: waking the SPE does not count

/// The man of the 2D demo.
ppu::Lattice2d man132() {
  std::vector<std::string> rows;
  const auto add = [&](int count, const char* row) {
    rows.insert(rows.end(), static_cast<std::size_t>(count), row);
  };
  add(4, "      ####");
  add(1, "       ##");
  add(2, "################");
  add(2, "     ######");
  add(7, "     ##  ##");
  return ppu::lattice_2d_from_cells(ppu::cells_from_rows(rows), kSpacing);
}

/// 32 x 32 particles.
ppu::Lattice2d block1024() {
  const std::vector<std::string> rows(31, std::string(31, '#'));
  return ppu::lattice_2d_from_cells(ppu::cells_from_rows(rows), kSpacing);
}

struct SolverCase2d {
  SolverCase2d(ppu::Lattice2d body, int half_width)
      : lattice(std::move(body)),
        plan(std::make_shared<const ppu::MatchingPlan2d<float>>(lattice, half_width,
                                                                ppu::particle_masses(lattice, 1000))),
        jobs(memory, {.spes = 1}, job_loop),
        waker(jobs),
        bodies(std::max<std::size_t>(1, kParticlesAtOnce / lattice.particles.size())),
        kernel_plan(lattice, *plan),
        spes(memory, jobs, kernel, std::vector{ppu::MatchOrchestrator2d::Model{&kernel_plan, bodies}}),
        eigen(plan),
        shared_sums(plan, ppu::SumMethod::kBarPlateCube),
        naive_sums(plan, ppu::SumMethod::kNaive) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      const Eigen::Vector2f p = lattice.rest_position(i);
      x.push_back({p.x() + 0.2f * p.y() * p.y(), p.y()});  // bent
    }
    v.resize(x.size());
    for (std::size_t b = 0; b < bodies; ++b)
      for (std::size_t i = 0; i < x.size(); ++i) spes.positions(0, b)[i] = {x[i].x(), x[i].y()};
  }

  void run_spes() {
    for (std::size_t b = 0; b < bodies; ++b) std::ranges::fill(spes.velocities(0, b), spu::MatchVector2d{});
    const ppu::MatchOrchestrator2d::Settings settings{.pull = kAlpha / kStep, .damping = kDamping};
    spes.step({&settings, 1});
  }

  void run_eigen() {
    std::ranges::fill(v, Eigen::Vector2f::Zero());
    eigen.step(x, v, kAlpha, kStep, kDamping);
  }

  void run_ppu(ppu::ShapeMatcher2d<float>& matcher) {
    std::ranges::fill(v, Eigen::Vector2f::Zero());
    matcher.step_velocities(x, v, kAlpha, kStep, kDamping);
  }

  ppu::Lattice2d lattice;
  std::shared_ptr<const ppu::MatchingPlan2d<float>> plan;
  dma::AddressSpace memory;
  ls_sim::KernelImage kernel = load_kernel("match_2d"), job_loop = load_kernel("job_loop");
  ppu::JobSystem jobs;
  SpeWaker waker;
  std::size_t bodies;
  ppu::MatchPlan2d kernel_plan;
  ppu::MatchOrchestrator2d spes;
  ppu::EigenSolver<2> eigen;
  ppu::ShapeMatcher2d<float> shared_sums, naive_sums;
  std::vector<Eigen::Vector2f> x, v;
};

void add_solver(std::vector<Benchmark>& all, const std::string& body, ppu::Lattice2d (*make)(),
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
