// Shape matching and damping of bodies of several kinds: the kernel match on one SPE, compared with the PPU's solvers.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <stdexcept>
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

/// The input of all solvers: several bodies of one model, so that no solver has one body's data in its caches.
struct Model {
  /// @param copies  0: as many as give kBenchParticles
  Model(ppu::Lattice<3> body, int half_width, std::size_t copies = 0)
      : lattice(std::move(body)),
        plan(std::make_shared<const ppu::MatchingPlan<float, 3>>(lattice, half_width,
                                                                 ppu::particle_masses(lattice, kDensity))),
        bodies(copies != 0 ? copies : std::max<std::size_t>(1, kBenchParticles / lattice.particles.size())) {
    SC_ASSERT(bodies > 0 && half_width > 0, "{} bodies in regions of half-width {}", bodies, half_width);
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) x.push_back(bent_position(lattice, i));
  }

  std::size_t particles() const { return bodies * x.size(); }

  ppu::Lattice<3> lattice;
  std::shared_ptr<const ppu::MatchingPlan<float, 3>> plan;
  std::size_t bodies;
  std::vector<Eigen::Vector3f> x;  // of each body
};

/// The kernel match on one SPE.
class SpeBodies {
 public:
  explicit SpeBodies(const Model& model)
      : jobs_(memory_, {.spes = 1}, job_loop_),
        image_(jobs_.load(kernel_)),
        spes_(memory_, ppu::MatchPlan(model.lattice, *model.plan), model.bodies),
        all_(model.bodies),
        chain_(jobs_, "match", model.bodies) {
    std::iota(all_.begin(), all_.end(), std::size_t{0});
    for (const std::size_t b : all_) {
      SC_ASSERT(model.x.size() <= spes_.positions(b).size(), "{} particles in a body of {}", model.x.size(),
                spes_.positions(b).size());
      for (std::size_t i = 0; i < model.x.size(); ++i)
        spes_.positions(b)[i] = {model.x[i].x(), model.x[i].y(), model.x[i].z(), 0};
    }
  }

  void step() {
    for (const std::size_t b : all_) std::ranges::fill(spes_.velocities(b), spu::SkinCorner{});
    chain_.clear();
    spes_.add_jobs(chain_, image_,
                   {.pull = kAlpha / kStep, .damping = kDamping, .least_iterations = 2, .most_iterations = 2},
                   all_, kBodiesPerJob);
    chain_.kick();
    chain_.wait();
    if (!chain_.failures().empty()) throw std::runtime_error(chain_.failures().front().message);
  }
  void wake() { waker_.wake(); }

 private:
  dma::AddressSpace memory_;
  ls_sim::KernelImage job_loop_ = load_kernel("job_loop"), kernel_ = load_kernel("match");
  ppu::JobSystem jobs_;
  SpeWaker waker_{jobs_};
  ppu::JobImage image_;
  ppu::MatchBodies<3> spes_;
  std::vector<std::size_t> all_;  // 0, 1, 2, ...
  ppu::JobChain chain_;           // last, so that it ends before the memory of its jobs is freed
};

void step(ppu::EigenSolver<3>& solver, std::span<const Eigen::Vector3f> x, std::span<Eigen::Vector3f> v) {
  solver.step(x, v, kAlpha, kStep, kDamping);
}
void step(ppu::ShapeMatcher<float, 3>& solver, std::span<const Eigen::Vector3f> x,
          std::span<Eigen::Vector3f> v) {
  solver.step_velocities(x, v, kAlpha, kStep, kDamping);
}

/// A PPU solver for each body.
template <typename Solver>
class PpuBodies {
 public:
  template <typename... Arguments>
  explicit PpuBodies(const Model& model, Arguments... arguments) {
    for (std::size_t b = 0; b < model.bodies; ++b)
      bodies_.push_back({Solver(model.plan, arguments...), model.x, std::vector(model.x)});
  }

  void step() {
    for (Body& body : bodies_) {
      SC_ASSERT(body.v.size() == body.x.size(), "{} velocities of {} particles", body.v.size(),
                body.x.size());
      std::ranges::fill(body.v, Eigen::Vector3f::Zero());
      tool::step(body.solver, body.x, body.v);
    }
  }

 private:
  struct Body {
    Solver solver;
    std::vector<Eigen::Vector3f> x, v;
  };
  std::vector<Body> bodies_;
};

void add_solver(std::vector<Benchmark>& all, const BenchBody& body, int half_width) {
  const Shared<Model> shared(
      [make = body.make, half_width] { return std::make_shared<Model>(make(), half_width); });
  const auto add = [&](std::string_view solver, auto make) {
    all.push_back({fmt::format("solver3d/{}/w{}/{}", body.name, half_width, solver), [=] {
                     const auto bodies = make(*shared.get());
                     Work work{shared.get()->particles(), [bodies] { bodies->step(); }};
                     if constexpr (requires { bodies->wake(); }) work.before = [bodies] { bodies->wake(); };
                     return work;
                   }});
  };
  using Matchers = PpuBodies<ppu::ShapeMatcher<float, 3>>;
  add("spe", [](const Model& model) { return std::make_shared<SpeBodies>(model); });
  add("eigen", [](const Model& model) { return std::make_shared<PpuBodies<ppu::EigenSolver<3>>>(model); });
  add("ppu",
      [](const Model& model) { return std::make_shared<Matchers>(model, ppu::SumMethod::kBarPlateCube); });
  add("naive", [](const Model& model) { return std::make_shared<Matchers>(model, ppu::SumMethod::kNaive); });
}

}  // namespace

void add_solver_benchmarks(std::vector<Benchmark>& all) {
  for (const BenchBody& body : bench_bodies())
    for (int w = 1; w <= 4; ++w) add_solver(all, body, w);
  all.push_back({"solver3d/one1000/w2/spe", [] {
                   const Model model(bench_block({10, 10, 10}), 2, 1);
                   const auto body = std::make_shared<SpeBodies>(model);
                   return Work{model.particles(), [body] { body->step(); }};
                 }});
}

}  // namespace softcell::tool
