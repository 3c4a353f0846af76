// softcell bench: kernels and what they are compared with, measured in turn in one run.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <vector>

#include "json_file.h"
#include "kernel_samples.h"
#include "softcell/ls_sim/spe_pool.h"
#include "softcell/ppu/shape_matching.h"
#include "softcell/ppu/shapes.h"
#include "softcell/ppu/skin_orchestrator.h"
#include "softcell/ppu/skin_scalar.h"
#include "usage_error.h"
#include "verbs.h"

namespace softcell::demos {
namespace {

constexpr int kRounds = 31;                // of which the minimum and the median are reported
constexpr std::size_t kSkinnedBodies = 8;  // in one frame, so that waking the SPE does not count

/// One thing to measure: `run` does `items` items of work.
struct Benchmark {
  std::string name;
  std::size_t items = 0;
  std::function<void()> run;
  std::vector<double> nanoseconds = {};  // per item, one for each round
};

/// A body in a bent pose, so that nothing is a special case.
struct SkinCase {
  SkinCase(std::string body_name, const ppu::TriangleMesh& body_mesh, float cell_size)
      : name(std::move(body_name)),
        lattice(ppu::voxelize(body_mesh, cell_size)),
        embedding(std::make_shared<ppu::Embedding>(ppu::embed(body_mesh, lattice))),
        pool(memory, {.spes = 1}),
        kernel(load_kernel("skin")),
        orchestrator(memory, pool, kernel),
        scalar_out(kSkinnedBodies, std::vector<spu::SkinnedVertex>(4 * embedding->groups.size())) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      Eigen::Vector3f x = lattice.rest_position(i);
      x.x() += 0.1f * x.y() * x.y();
      x.z() += 0.05f * x.x() * x.y();
      positions.push_back(x);
      corners.push_back({x.x(), x.y(), x.z(), 0});
    }
    for (std::size_t body = 0; body < kSkinnedBodies; ++body) {
      orchestrator.add(embedding, corners.size());
      all_corners.push_back(corners);
    }
  }

  void run_spe() {
    orchestrator.kick(all_corners);
    orchestrator.drain();
  }

  void run_scalar() {
    const Eigen::Vector3f origin(-2, -2, -2);
    for (auto& out : scalar_out) {
      for (const ppu::SkinPart& part : embedding->parts) {
        ppu::skin_scalar(
            *embedding, part, positions, origin,
            std::span(out).subspan(4 * std::size_t{part.first_group}, 4 * std::size_t{part.group_count}));
      }
    }
  }

  std::string name;
  ppu::Lattice lattice;
  std::shared_ptr<ppu::Embedding> embedding;
  dma::AddressSpace memory;
  ls_sim::SpePool pool;
  ls_sim::KernelImage kernel;
  ppu::SkinOrchestrator orchestrator;
  std::vector<Eigen::Vector3f> positions;
  std::vector<spu::SkinCorner> corners;
  std::vector<std::span<const spu::SkinCorner>> all_corners;  // one for each body, all in the same pose
  std::vector<std::vector<spu::SkinnedVertex>> scalar_out;    // of each body
};

void add_skin(std::vector<Benchmark>& all, const std::shared_ptr<SkinCase>& body) {
  const std::size_t vertices = kSkinnedBodies * body->embedding->slot_of_vertex.size();
  all.push_back({"skin/" + body->name + "/spe", vertices, [body] { body->run_spe(); }});
  all.push_back({"skin/" + body->name + "/scalar", vertices, [body] { body->run_scalar(); }});
}

/// The PPU's solver on a full block, matching and damping, from the same bent pose in every step.
void add_solver(std::vector<Benchmark>& all, int half_width) {
  using Vector = Eigen::Vector3f;
  constexpr int kSide = 9;  // cells: 10 x 10 x 10 particles
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z) cells.emplace_back(x, y, z);
  const auto lattice =
      std::make_shared<ppu::Lattice>(ppu::lattice_from_cells(cells, 0.1f, {-0.45f, -0.45f, -0.45f}));
  const auto masses = ppu::particle_masses(*lattice, 1000);
  const auto plan = std::make_shared<const ppu::MatchingPlan<float>>(*lattice, half_width, masses);
  for (const auto& [label, method] :
       {std::pair{"eigen", ppu::SumMethod::kBarPlateCube}, std::pair{"naive", ppu::SumMethod::kNaive}}) {
    const auto matcher = std::make_shared<ppu::ShapeMatcher<float>>(plan, method);
    const auto x = std::make_shared<std::vector<Vector>>();
    for (std::size_t i = 0; i < lattice->particles.size(); ++i) {
      Vector p = lattice->rest_position(i);
      p.x() += 0.2f * p.y() * p.y();
      x->push_back(p);
    }
    const auto v = std::make_shared<std::vector<Vector>>(x->size(), Vector::Zero());
    all.push_back({fmt::format("solver3d/block1000/w{}/{}", half_width, label), x->size(), [matcher, x, v] {
                     std::fill(v->begin(), v->end(), Vector::Zero());
                     matcher->step_velocities(*x, *v, 0.5f, 1.0f / 60, 0.1f);
                   }});
  }
}

std::vector<Benchmark> make_benchmarks() {
  std::vector<Benchmark> all;
  add_skin(all, std::make_shared<SkinCase>("sphere", ppu::make_sphere(0.7f, 48), 0.28f));
  add_skin(all, std::make_shared<SkinCase>("torus", ppu::make_torus(0.72f, 0.28f, 192, 80), 0.2f));
  for (int w = 1; w <= 3; ++w) add_solver(all, w);
  return all;
}

void measure(std::vector<Benchmark>& all) {
  for (Benchmark& benchmark : all) benchmark.run();  // caches, first allocations
  // Round by round, so that a change of the machine's speed meets all alike.
  for (int round = 0; round < kRounds; ++round) {
    for (Benchmark& benchmark : all) {
      const auto begin = std::chrono::steady_clock::now();
      benchmark.run();
      const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - begin;
      benchmark.nanoseconds.push_back(elapsed.count() / static_cast<double>(benchmark.items));
    }
  }
  for (Benchmark& benchmark : all) std::sort(benchmark.nanoseconds.begin(), benchmark.nanoseconds.end());
}

}  // namespace

int run_bench(const BenchOptions& options) {
  std::vector<Benchmark> all = make_benchmarks();
  try {
    const std::regex filter(options.filter);
    std::erase_if(all, [&](const Benchmark& b) { return !std::regex_search(b.name, filter); });
  } catch (const std::regex_error&) {
    throw UsageError("--filter " + options.filter + " is not a regular expression");
  }
  if (all.empty()) throw UsageError("--filter " + options.filter + " leaves no benchmark");
  measure(all);

  auto document = nlohmann::ordered_json::array();
  fmt::print("{:<32} {:>10} {:>10} {:>9}   nanoseconds per item, {} rounds\n", "name", "minimum", "median",
             "items", kRounds);
  for (const Benchmark& b : all) {
    const double least = b.nanoseconds.front(), median = b.nanoseconds[b.nanoseconds.size() / 2];
    fmt::print("{:<32} {:>10.2f} {:>10.2f} {:>9}\n", b.name, least, median, b.items);
    document.push_back({{"name", b.name}, {"ns_min", least}, {"ns_median", median}, {"items", b.items}});
  }
  if (options.json) write_json(*options.json, document);
  return 0;
}

}  // namespace softcell::demos
