#pragma once
// What is true of every piece of every body.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "../mesh_checks.h"
#include "ppu/fracture/cracks.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {

/// Sides of triangles that are not met by as many in the other direction: 0 for a closed, consistently wound mesh, in which crack sides
/// may lie on each other.
inline std::size_t unmet_sides(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> number = position_numbers(mesh);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = number[t[k]], b = number[t[(k + 1) % 3]];
      if (a != b) sides[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  std::size_t unmet = 0;
  for (const auto& [side, balance] : sides) unmet += balance != 0 ? 1 : 0;
  return unmet;
}

/// Momenta of bodies together, about the origin.
struct Momenta {
  double mass = 0;
  Eigen::Vector3d momentum{0, 0, 0}, angular_momentum{0, 0, 0}, moment{0, 0, 0};

  void add(const SoftBody<3>& body) {
    for (std::size_t i = 0; i < body.positions().size(); ++i) {
      const double m = double{body.model().masses()[i]};
      const Eigen::Vector3d x = body.position(i).cast<double>(), v = body.velocities()[i].cast<double>();
      mass += m;
      moment += m * x;
      momentum += m * v;
      angular_momentum += m * x.cross(v);
    }
  }
};

/// Any motion, so that nothing is the same by chance.
inline void stir(SoftBody<3>& body, std::mt19937& random, float most) {
  std::uniform_real_distribution<float> number(-most, most);
  const auto vector = [&] { return Eigen::Vector3f(number(random), number(random), number(random)); };
  for (std::size_t i = 0; i < body.positions().size(); ++i)
    body.set_particle(i, body.position(i) + 0.02f * vector(), 3 * vector());
}

}  // namespace softcell::ppu
