// The kernel match on an SPE against the PPU's solver in double precision, and against what must be true of
// any solver.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>

#include "ppu/lattices.h"
#include "softcell/ppu/match_orchestrator.h"
#include "softcell/ppu/shape_matching.h"
#include "softcell/ppu/shapes.h"
#include "softcell/ppu/stiffness.h"
#include "spu_kernels/kernel_image.h"

namespace softcell {
namespace {

using Eigen::Vector3d;
using ppu::Lattice;
using ppu::MatchSettings;
using ppu::test::Random;
using Vectors = std::vector<Vector3d>;

constexpr MatchSettings kOnlyGoals{.pull = 1, .damping = 0};  // with velocities of zero: dv = g - x

/// One body on an SPE.
class MatchRig {
 public:
  MatchRig(Lattice body, int half_width, const ls_sim::SpeOptions& options = {.spes = 1})
      : lattice(std::move(body)),
        masses(ppu::particle_masses(lattice, 1000)),
        plan(lattice, half_width, masses),
        match_plan(lattice, plan),
        image_(test::kernel_image("match")),
        pool_(memory_, options),
        spes(memory_, pool_, image_, match_plan, 1) {
    set(rest(), Vectors(lattice.particles.size(), Vector3d::Zero()));
    double largest = 0;
    for (const Vector3d& a : rest()) largest = std::max(largest, (a - rest()[0]).norm());
    size = largest;
  }

  Vectors rest() const {
    Vectors x;
    for (std::size_t i = 0; i < lattice.particles.size(); ++i)
      x.push_back(lattice.rest_position(i).cast<double>());
    return x;
  }

  void set(const Vectors& x, const Vectors& v) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      spes.positions(0)[i] = of(x[i]);
      spes.velocities(0)[i] = of(v[i]);
    }
  }
  Vectors positions() { return from(spes.positions(0)); }
  Vectors velocities() { return from(spes.velocities(0)); }

  /// g - x by the kernel.
  Vectors pulls(const Vectors& x, MatchSettings settings = kOnlyGoals) {
    set(x, Vectors(x.size(), Vector3d::Zero()));
    spes.step(settings);
    return velocities();
  }

  /// What the engine does after the solver.
  void advance(double h) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      auto& x = spes.positions(0)[i];
      const auto& v = spes.velocities(0)[i];
      x.x += static_cast<float>(h) * v.x;
      x.y += static_cast<float>(h) * v.y;
      x.z += static_cast<float>(h) * v.z;
    }
  }

  Vector3d momentum(const Vectors& v) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < v.size(); ++i) sum += double{masses[i]} * v[i];
    return sum;
  }
  Vector3d angular_momentum(const Vectors& x, const Vectors& v) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < v.size(); ++i) sum += double{masses[i]} * (x[i] - x[0]).cross(v[i]);
    return sum;
  }
  double energy(const Vectors& v) const {
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) sum += double{masses[i]} * v[i].squaredNorm() / 2;
    return sum;
  }
  /// Sum of m |v|: what momenta are small against.
  double effort(const Vectors& v) const {
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) sum += double{masses[i]} * v[i].norm();
    return sum;
  }

  Lattice lattice;
  std::vector<float> masses;
  ppu::MatchingPlan<float> plan;
  ppu::MatchPlan match_plan;
  double size = 0;

 private:
  static spu::SkinCorner of(const Vector3d& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
  }
  static Vectors from(std::span<const spu::SkinCorner> vectors) {
    Vectors result;
    for (const auto& v : vectors) result.emplace_back(v.x, v.y, v.z);
    return result;
  }

  dma::AddressSpace memory_;
  ls_sim::KernelImage image_;
  ls_sim::SpePool pool_;

 public:
  ppu::MatchOrchestrator spes;
};

/// Turned, bent, and shaken by up to `noise` metres; exactly as floats hold it.
Vectors deformed(const MatchRig& rig, std::uint64_t seed, double noise) {
  Random random(seed);
  const Eigen::Quaterniond turn = random.rotation();
  const Vector3d shift = 3 * random.vector();
  Vectors x;
  for (Vector3d p : rig.rest()) {
    p.x() += 0.3 * p.y() * p.y() / rig.size;
    p = turn * p + shift + noise * random.vector();
    x.push_back(p.cast<float>().cast<double>());
  }
  return x;
}

Vectors reference_goals(const MatchRig& rig, int half_width, const Vectors& x) {
  const auto plan = std::make_shared<const ppu::MatchingPlan<double>>(rig.lattice, half_width, rig.masses);
  ppu::ShapeMatcher<double> matcher(plan);
  Vectors g(x.size());
  matcher.goals(x, g);
  return g;
}

TEST(Match, GoalsAgreeWithTheReferenceOnEveryLattice) {
  for (const auto& [name, lattice] : ppu::test::all_lattices()) {
    for (int w = 1; w <= 4; ++w) {
      MatchRig rig(lattice, w);
      const Vectors x = deformed(rig, 17, 0.02);
      const Vectors expected = reference_goals(rig, w, x), pulls = rig.pulls(x);
      for (std::size_t i = 0; i < x.size(); ++i)
        ASSERT_LT((pulls[i] - (expected[i] - x[i])).norm(), 1e-5 * rig.size)
            << name << ", w = " << w << ", particle " << i << ", residual " << rig.spes.residual(0);
    }
  }
}

}  // namespace
}  // namespace softcell
