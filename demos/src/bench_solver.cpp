// Shape matching and damping: the kernel match on one SPE beside the PPU's solver, on bodies of several
// kinds.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "benchmarks.h"
#include "eigen_solver.h"
#include "kernel_samples.h"
#include "softcell/ppu/job_system.h"
#include "softcell/ppu/match_orchestrator.h"
#include "softcell/ppu/shape_matching.h"

namespace softcell::demos {
namespace {

constexpr float kSpacing = 0.1f, kAlpha = 0.5f, kStep = 1.0f / 60, kDamping = 0.1f;
constexpr std::size_t kParticlesAtOnce = 16'000;  // so many in one measurement: waking the SPE does not count

/// Cells (x, y, z) of a box of `size` cells for which `inside` is true of their centres, seen from the box's.
template <typename Inside>
ppu::Lattice lattice_where(const Eigen::Vector3i& size, const Inside& inside) {
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < size.x(); ++x)
    for (int y = 0; y < size.y(); ++y)
      for (int z = 0; z < size.z(); ++z)
        if (inside(x + 0.5 - size.x() / 2.0, y + 0.5 - size.y() / 2.0, z + 0.5 - size.z() / 2.0))
          cells.emplace_back(x, y, z);
  return ppu::lattice_from_cells(cells, kSpacing, -0.5f * kSpacing * size.cast<float>());
}

double square(double v) { return v * v; }

/// 10 x 10 x 10 particles.
ppu::Lattice block1000() {
  return lattice_where({9, 9, 9}, [](double, double, double) { return true; });
}

/// A ring of 10 cells with a tube of 4.
ppu::Lattice torus() {
  return lattice_where({14, 14, 4}, [](double x, double y, double z) {
    return square(std::hypot(x, y) - 4.8) + square(z) < square(2);
  });
}

/// A hollow sphere, its wall one cell thick.
ppu::Lattice shell() {
  return lattice_where({9, 9, 9}, [](double x, double y, double z) {
    const double r = std::sqrt(square(x) + square(y) + square(z));
    return r < 4.4 && r > 3.4;
  });
}

/// A body, a head, two flippers and two feet: about 150 particles.
ppu::Lattice penguin150() {
  return lattice_where({7, 8, 4}, [](double x, double y, double z) {
    const bool body = square(x / 2) + square((y + 1) / 2.9) + square(z / 2) < 1.05;
    const bool head = square(x / 1.3) + square((y - 2.7) / 1.3) + square(z / 1.3) < 1;
    const bool flipper = std::abs(x) < 3.5 && std::abs(y) < 1 && std::abs(z) < 0.6;
    return body || head || flipper;
  });
}

/// The same bent pose for all solvers and steps.
Eigen::Vector3f bent(const ppu::Lattice& lattice, std::size_t particle) {
  Eigen::Vector3f p = lattice.rest_position(particle);
  p.x() += 0.2f * p.y() * p.y();
  return p;
}

struct SolverCase {
  SolverCase(std::string body_name, ppu::Lattice body, int half_width)
      : name(fmt::format("solver3d/{}/w{}", body_name, half_width)),
        lattice(std::move(body)),
        plan(std::make_shared<const ppu::MatchingPlan<float>>(lattice, half_width,
                                                              ppu::particle_masses(lattice, 1000))),
        jobs(memory, {.spes = 1}, job_loop),
        bodies(std::max<std::size_t>(1, kParticlesAtOnce / lattice.particles.size())),
        spes(memory, jobs, kernel, ppu::MatchPlan(lattice, *plan), bodies),
        eigen(plan),
        shared_sums(plan, ppu::SumMethod::kBarPlateCube),
        naive_sums(plan, ppu::SumMethod::kNaive) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) x.push_back(bent(lattice, i));
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

  std::string name;
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

void add_solver(std::vector<Benchmark>& all, const std::string& name, const ppu::Lattice& lattice,
                int half_width) {
  const auto body = std::make_shared<SolverCase>(name, lattice, half_width);
  const std::size_t particles = body->x.size();
  all.push_back({body->name + "/spe", body->bodies * particles, [body] { body->run_spes(); }});
  all.push_back({body->name + "/eigen", particles, [body] { body->run_eigen(); }});
  all.push_back({body->name + "/ppu", particles, [body] { body->run_ppu(body->shared_sums); }});
  if (half_width <= 2)
    all.push_back({body->name + "/naive", particles, [body] { body->run_ppu(body->naive_sums); }});
}

}  // namespace

void add_solver_benchmarks(std::vector<Benchmark>& all) {
  for (int w = 1; w <= 4; ++w) {
    add_solver(all, "block1000", block1000(), w);
    add_solver(all, "torus", torus(), w);
    add_solver(all, "shell", shell(), w);
    add_solver(all, "penguin150", penguin150(), w);
  }
}

}  // namespace softcell::demos
