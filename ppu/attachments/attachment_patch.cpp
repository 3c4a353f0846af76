#include "ppu/attachments/attachment_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ppu/numbers/keep_each_once.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

/// @throws std::invalid_argument
void check_numbers(const std::vector<std::uint32_t>& numbers, std::size_t count, const char* what) {
  for (const std::uint32_t number : numbers)
    if (number >= count)
      throw std::invalid_argument("a patch has " + std::string(what) + " " + std::to_string(number) +
                                  "; the soft body has " + std::to_string(count) + ", numbered from 0");
}

template <int kDimension>
void check(const Patch<kDimension>& patch, const SoftBody<kDimension>& body) {
  const int given = int{!patch.particles.empty()} + int{!patch.cells.empty()} + int{patch.radius != 0};
  if (given != 1)
    throw std::invalid_argument("a patch has " + std::to_string(given) +
                                " of particles, cells and a radius; it needs exactly one of them");
  check_numbers(patch.particles, body.model().particles(), "particle");
  check_numbers(patch.cells, body.model().lattice().cells.size(), "cell");
  if (patch.radius != 0 && (!std::isfinite(patch.radius) || patch.radius < 0 || !patch.centre.allFinite()))
    throw std::invalid_argument("the radius of a patch is " + base::shortest(patch.radius) +
                                " m; it must be above 0 and its centre finite");
}

template <int kDimension>
[[noreturn]] void refuse_empty(const Patch<kDimension>& patch, const char* what, float nearest) {
  throw std::invalid_argument(std::string("no ") + what + " of the soft body is within " +
                              base::shortest(patch.radius) + " m of the middle of a patch; the nearest is " +
                              base::shortest(nearest) + " m away");
}

template <int kDimension>
std::vector<std::uint32_t> corners_of(const std::vector<std::uint32_t>& cells,
                                      const Lattice<kDimension>& lattice) {
  std::vector<std::uint32_t> particles;
  for (const std::uint32_t cell : cells)
    particles.insert(particles.end(), lattice.corners[cell].begin(), lattice.corners[cell].end());
  return particles;
}

template <int kDimension>
PatchParticles<kDimension> made_of(std::vector<std::uint32_t> particles, const SoftBody<kDimension>& body) {
  keep_each_once(particles);
  PatchParticles<kDimension> result;
  for (const std::uint32_t particle : particles) {
    result.positions.push_back(body.position(particle));
    result.masses.push_back(body.model().masses()[particle]);
  }
  result.particles = std::move(particles);
  return result;
}

}  // namespace

PatchParticles<3> particles_of(const Patch<3>& patch, const SoftBody<3>& body, const ContactModel& contact) {
  check(patch, body);
  if (!patch.particles.empty()) return made_of(patch.particles, body);
  if (!patch.cells.empty()) return made_of(corners_of(patch.cells, body.model().lattice()), body);
  std::vector<std::uint32_t> cells;
  float nearest = std::numeric_limits<float>::max();
  for (const SurfacePointAtRest& point : contact.surface.points()) {
    const Eigen::Vector3f place =
        anchor_in_cell(body.model().lattice(), point.cell, point.xi).of(body.positions());
    const float distance = (place - patch.centre).norm();
    nearest = std::min(nearest, distance);
    if (distance <= patch.radius) cells.push_back(point.cell);
  }
  if (cells.empty()) refuse_empty(patch, "surface", nearest);
  return made_of(corners_of(cells, body.model().lattice()), body);
}

PatchParticles<2> particles_of(const Patch<2>& patch, const SoftBody<2>& body) {
  check(patch, body);
  if (!patch.particles.empty()) return made_of(patch.particles, body);
  if (!patch.cells.empty()) return made_of(corners_of(patch.cells, body.model().lattice()), body);
  std::vector<std::uint32_t> particles;
  float nearest = std::numeric_limits<float>::max();
  for (std::uint32_t i = 0; i < body.positions().size(); ++i) {
    const float distance = (body.position(i) - patch.centre).norm();
    nearest = std::min(nearest, distance);
    if (distance <= patch.radius) particles.push_back(i);
  }
  if (particles.empty()) refuse_empty(patch, "particle", nearest);
  return made_of(std::move(particles), body);
}

}  // namespace softcell::ppu
