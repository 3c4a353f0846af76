#include "bench_bodies.h"
#include "softcell/base/assert.h"

#include <array>
#include <cmath>
#include <vector>

namespace softcell::tool {
namespace {

/// Cells (x, y, z) of a box of `size` cells for which `inside` is true at their centres, relative to the box's centre.
template <typename Inside>
ppu::Lattice<3> lattice_where(const Eigen::Vector3i& size, const Inside& inside) {
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < size.x(); ++x)
    for (int y = 0; y < size.y(); ++y)
      for (int z = 0; z < size.z(); ++z)
        if (inside(x + 0.5 - size.x() / 2.0, y + 0.5 - size.y() / 2.0, z + 0.5 - size.z() / 2.0))
          cells.emplace_back(x, y, z);
  SC_ASSERT(!cells.empty(), "a body of no cells in {} x {} x {}", size.x(), size.y(), size.z());
  return ppu::lattice_from_cells(cells, kSpacing, -0.5f * kSpacing * size.cast<float>());
}

double square(double v) { return v * v; }

ppu::Lattice<3> block1000() { return bench_block({10, 10, 10}); }

/// A ring 10 cells in diameter with a tube of 4 cells.
ppu::Lattice<3> torus() {
  return lattice_where({14, 14, 4}, [](double x, double y, double z) {
    return square(std::hypot(x, y) - 4.8) + square(z) < square(2);
  });
}

/// A hollow sphere, its wall one cell thick.
ppu::Lattice<3> shell() {
  return lattice_where({9, 9, 9}, [](double x, double y, double z) {
    const double r = std::sqrt(square(x) + square(y) + square(z));
    return r < 4.4 && r > 3.4;
  });
}

/// A body, a head and two flippers: about 150 particles.
ppu::Lattice<3> penguin150() {
  return lattice_where({7, 8, 4}, [](double x, double y, double z) {
    const bool body = square(x / 2) + square((y + 1) / 2.9) + square(z / 2) < 1.05;
    const bool head = square(x / 1.3) + square((y - 2.7) / 1.3) + square(z / 1.3) < 1;
    const bool flipper = std::abs(x) < 3.5 && std::abs(y) < 1 && std::abs(z) < 0.6;
    return body || head || flipper;
  });
}

/// A body, a cabin on it, and an antenna one cell thick at the back.
ppu::Lattice<3> car() {
  return lattice_where({11, 10, 5}, [](double x, double y, double z) {
    const bool body = y < -3;
    const bool cabin = y < -1 && x > -3 && x < 3;
    const bool antenna = x > 4 && x < 5 && std::abs(z) < 0.5;
    return body || cabin || antenna;
  });
}

constexpr std::array<BenchBody, 5> kBodies{
    {{"block1000", block1000}, {"torus", torus}, {"shell", shell}, {"penguin150", penguin150}, {"car", car}}};

}  // namespace

ppu::Lattice<3> bench_block(const Eigen::Vector3i& particles) {
  SC_ASSERT(particles.minCoeff() >= 2, "a block of {} x {} x {} particles", particles.x(), particles.y(),
            particles.z());
  return lattice_where(particles - Eigen::Vector3i::Ones(), [](double, double, double) { return true; });
}

std::span<const BenchBody> bench_bodies() { return kBodies; }

Eigen::Vector3f bent_position(const ppu::Lattice<3>& lattice, std::size_t particle) {
  SC_ASSERT(particle < lattice.particles.size(), "particle {} of {}", particle, lattice.particles.size());
  Eigen::Vector3f p = lattice.rest_position(particle);
  p.x() += 0.2f * p.y() * p.y();
  return p;
}

}  // namespace softcell::tool
