#include "surface_grip.h"

#include <algorithm>

#include "ppu/surfaces/cell_finder.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;

std::uint32_t nearest_particle(const ppu::SoftBody<3>& body, const Vector3f& point) {
  const auto positions = body.positions();
  const auto nearer = [&](const Vector3f& a, const Vector3f& b) {
    return (a - point).squaredNorm() < (b - point).squaredNorm();
  };
  return static_cast<std::uint32_t>(std::min_element(positions.begin(), positions.end(), nearer) -
                                    positions.begin());
}

}  // namespace

SurfaceGrip::SurfaceGrip(ppu::SoftBody<3>& body, const Vector3f& point)
    : body_(body), place_(place_of(body, point)), grip_(body, place_.nearest()) {
  for (std::size_t k = 0; k < place_.corners.size(); ++k)
    patch_share_ += double{place_.shares[k]} * double{grip_.patch().weights[place_.corners[k]]};
}

SurfaceGrip::Place SurfaceGrip::place_of(const ppu::SoftBody<3>& body, const Vector3f& point) {
  SC_ASSERT(point.allFinite(), "a body is held at ({}, {}, {})", point.x(), point.y(), point.z());
  const ppu::Lattice<3>& lattice = body.model().lattice();
  ppu::CellFinder cells;
  cells.place(lattice, body.positions());
  const auto found = cells.find(point, [](std::uint32_t) { return true; });
  Place place;
  if (!found) {
    place.corners.fill(nearest_particle(body, point));
    place.shares = {1};
    return place;
  }
  place.corners = lattice.corners[found->cell];
  for (std::size_t k = 0; k < place.corners.size(); ++k) {
    place.shares[k] = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float xi = found->xi[static_cast<int>(axis)];
      place.shares[k] *= ((k >> axis) & 1) != 0 ? xi : 1 - xi;
    }
  }
  return place;
}

std::uint32_t SurfaceGrip::Place::nearest() const {
  return corners[static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin())];
}

Vector3f SurfaceGrip::point() const {
  Vector3f point(0, 0, 0);
  for (std::size_t k = 0; k < place_.corners.size(); ++k)
    point += place_.shares[k] * body_.position(place_.corners[k]);
  return point;
}

void SurfaceGrip::pull(const HandMotion<3>& hand, const Vector3f& gravity, float step) {
  HeldPoint<3> held{.position = point().cast<double>(), .patch_share = patch_share_};
  const HeldRest<3>& rest = grip_.rest();
  for (std::size_t k = 0; k < place_.corners.size(); ++k) {
    const double share = double{place_.shares[k]};
    held.velocity += share * body_.velocities()[place_.corners[k]].cast<double>();
    held.at_rest += share * rest.positions[place_.corners[k]].cast<double>();
  }
  grip_.pull(held, hand, gravity, step);
}

void SurfaceGrip::let_go(const Vector3f& velocity) { grip_.let_go(velocity); }

}  // namespace softcell::demos
