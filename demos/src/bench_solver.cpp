// Shape matching and damping on the PPU.

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "benchmarks.h"
#include "softcell/ppu/shape_matching.h"

namespace softcell::demos {
namespace {

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

}  // namespace

void add_solver_benchmarks(std::vector<Benchmark>& all) {
  for (int w = 1; w <= 3; ++w) add_solver(all, w);
}

}  // namespace softcell::demos
