#pragma once
// The bodies on which solvers are compared, as lattices.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string_view>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::tool {

struct BenchBody {
  std::string_view name;
  ppu::Lattice<3> (*make)();
};

/// block1000, torus, shell, penguin150 and car; about 150 to 1000 particles, 0.1 m apart.
std::span<const BenchBody> bench_bodies();

/// A block of particles 0.1 m apart. @param particles  along each axis
ppu::Lattice<3> bench_block(const Eigen::Vector3i& particles);

/// Particles in one measurement, in as many bodies as that needs: then the time to wake an SPE is negligible, and the data of all bodies
/// are more than the nearest caches hold, as in a scene.
inline constexpr std::size_t kBenchParticles = 16'000;
/// The same for the bodies of all solver benchmarks: metres, seconds, kg/m^3.
inline constexpr float kSpacing = 0.1f, kStep = 1.0f / 60, kAlpha = 0.5f, kDamping = 0.1f, kDensity = 1000;
inline constexpr std::size_t kBodiesPerJob = 16;

/// The position of a particle in a bent pose of the body, which is the same for all solvers.
Eigen::Vector3f bent_position(const ppu::Lattice<3>& lattice, std::size_t particle);

}  // namespace softcell::tool
