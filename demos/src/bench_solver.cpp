// Shape matching and damping: the kernel match on one SPE beside the PPU's solver, on bodies of several
// kinds.

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bench_bodies.h"
#include "benchmarks.h"
#include "eigen_solver.h"
#include "kernel_samples.h"
#include "softcell/ppu/job_system.h"
#include "softcell/ppu/match_orchestrator.h"
#include "softcell/ppu/shape_matching.h"

namespace softcell::demos {
namespace {

constexpr float kAlpha = 0.5f, kStep = 1.0f / 60, kDamping = 0.1f;
constexpr std::size_t kParticlesAtOnce = 16'000;  // so many in one measurement: waking the SPE does not count

struct SolverCase {
  SolverCase(ppu::Lattice body, int half_width)
      : lattice(std::move(body)),
        plan(std::make_shared<const ppu::MatchingPlan<float>>(lattice, half_width,
                                                              ppu::particle_masses(lattice, 1000))),
        jobs(memory, {.spes = 1}, job_loop),
        bodies(std::max<std::size_t>(1, kParticlesAtOnce / lattice.particles.size())),
        spes(memory, jobs, kernel, ppu::MatchPlan(lattice, *plan), bodies),
        eigen(plan),
        shared_sums(plan, ppu::SumMethod::kBarPlateCube),
        naive_sums(plan, ppu::SumMethod::kNaive) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) x.push_back(bent_position(lattice, i));
    v.resize(x.size());
    for (std::size_t b = 0; b < bodies; ++b)
      for (std::size_t i = 0; i < x.size(); ++i) spes.positions(b)[i] = {x[i].x(), x[i].y(), x[i].z(), 0};
  }

  void run_spes() {
    for (std::size_t b = 0; b < bodies; ++b) std::ranges::fill(spes.velocities(b), spu::SkinCorner{});
    spes.step({.pull = kAlpha / kStep, .damping = kDamping, .least_iterations = 2, .most_iterations = 2});
  }

  void run_eigen() {
    std::ranges::fill(v, Eigen::Vector3f::Zero());
    eigen.step(x, v, kAlpha, kStep, kDamping);
  }

  void run_ppu(ppu::ShapeMatcher<float>& matcher) {
    std::ranges::fill(v, Eigen::Vector3f::Zero());
    matcher.step_velocities(x, v, kAlpha, kStep, kDamping);
  }

  ppu::Lattice lattice;
  std::shared_ptr<const ppu::MatchingPlan<float>> plan;
  dma::AddressSpace memory;
  ls_sim::KernelImage job_loop = load_kernel("job_loop"), kernel = load_kernel("match");
  ppu::JobSystem jobs;
  std::size_t bodies;
  ppu::MatchOrchestrator spes;
  EigenSolver eigen;
  ppu::ShapeMatcher<float> shared_sums, naive_sums;
  std::vector<Eigen::Vector3f> x, v;
};

void add_solver(std::vector<Benchmark>& all, const BenchBody& body, int half_width) {
  const Shared<SolverCase> shared(
      [make = body.make, half_width] { return std::make_shared<SolverCase>(make(), half_width); });
  const auto add = [&](std::string_view solver, auto run, bool many_bodies = false) {
    all.push_back({fmt::format("solver3d/{}/w{}/{}", body.name, half_width, solver), [=] {
                     const auto rig = shared.get();
                     return Work{(many_bodies ? rig->bodies : 1) * rig->x.size(), [=] { run(*rig); }};
                   }});
  };
  add(
      "spe", [](SolverCase& rig) { rig.run_spes(); }, true);
  add("eigen", [](SolverCase& rig) { rig.run_eigen(); });
  add("ppu", [](SolverCase& rig) { rig.run_ppu(rig.shared_sums); });
  add("naive", [](SolverCase& rig) { rig.run_ppu(rig.naive_sums); });
}

}  // namespace

void add_solver_benchmarks(std::vector<Benchmark>& all) {
  for (const BenchBody& body : bench_bodies())
    for (int w = 1; w <= 4; ++w) add_solver(all, body, w);
}

}  // namespace softcell::demos
