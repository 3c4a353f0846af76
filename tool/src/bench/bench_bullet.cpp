// Bullet's own soft bodies on the lattices of the other solvers, without collisions.

#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "bench_bodies.h"
#include "benchmarks.h"
#include "ppu/bullet/bullet_vector.h"
#include "softcell/base/assert.h"

// Included after the others: see bullet_links.h.
#include "bullet_links.h"

namespace softcell::tool {
namespace {

constexpr float kMatching = 0.5f;

using ppu::to_bullet;

/// A btSoftBody that is stepped from the same bent pose each time.
class BulletSoftBody {
 public:
  enum class Held {
    kPose,  ///< the whole body as one region, matched (btSoftBody::setPose)
    kLinks  ///< links along the edges and across the faces of cells
  };

  BulletSoftBody(const ppu::Lattice<3>& lattice, Held held) {
    const std::vector<float> masses = ppu::particle_masses(lattice, kDensity);
    SC_ASSERT(masses.size() == lattice.particles.size(), "{} masses of {} particles", masses.size(),
              lattice.particles.size());
    std::vector<btVector3> rest;
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      rest.push_back(to_bullet(lattice.rest_position(i)));
      bent_.push_back(to_bullet(bent_position(lattice, i)));
    }
    body_ = std::make_unique<btSoftBody>(&world_, static_cast<int>(rest.size()), rest.data(), masses.data());
    world_.m_gravity.setZero();
    body_->m_cfg.collisions = 0;
    body_->m_cfg.kDP = kDamping;
    if (held == Held::kPose) {
      body_->m_cfg.kMT = kMatching;
      body_->setPose(false, true);
    } else {
      append_links(lattice, *body_);
    }
  }

  void step() {
    SC_ASSERT(static_cast<std::size_t>(body_->m_nodes.size()) == bent_.size(), "{} nodes of {}",
              body_->m_nodes.size(), bent_.size());
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      btSoftBody::Node& node = body_->m_nodes[i];
      node.m_x = node.m_q = bent_[static_cast<std::size_t>(i)];
      node.m_v.setZero();
    }
    body_->predictMotion(kStep);
    body_->solveConstraints();
    body_->integrateMotion();
  }

 private:
  btSoftBodyWorldInfo world_;
  std::unique_ptr<btSoftBody> body_;
  std::vector<btVector3> bent_;
};

/// Several such bodies, as for the other solvers.
struct BulletBodies {
  BulletBodies(const ppu::Lattice<3>& lattice, BulletSoftBody::Held held) {
    SC_ASSERT(!lattice.particles.empty(), "{} cells without particles", lattice.cells.size());
    for (nodes = 0; nodes < kBenchParticles; nodes += lattice.particles.size())
      bodies.push_back(std::make_unique<BulletSoftBody>(lattice, held));
  }

  std::size_t nodes;
  std::vector<std::unique_ptr<BulletSoftBody>> bodies;
};

void add_bullet(std::vector<Benchmark>& all, const BenchBody& body, BulletSoftBody::Held held,
                std::string_view name) {
  const Shared<BulletBodies> shared(
      [=, make = body.make] { return std::make_shared<BulletBodies>(make(), held); });
  for (int w = 1; w <= 4; ++w) {
    all.push_back({fmt::format("solver3d/{}/w{}/{}", body.name, w, name), [=] {
                     const auto rig = shared.get();
                     return Work{rig->nodes, [rig] {
                                   for (const auto& each : rig->bodies) each->step();
                                 }};
                   }});
  }
}

}  // namespace

void add_bullet_benchmarks(std::vector<Benchmark>& all) {
  for (const BenchBody& body : bench_bodies()) {
    add_bullet(all, body, BulletSoftBody::Held::kPose, "bullet-pose");
    add_bullet(all, body, BulletSoftBody::Held::kLinks, "bullet-links");
  }
}

}  // namespace softcell::tool
