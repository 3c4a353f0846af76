#include "whole_body.h"

#include <Eigen/LU>
#include <algorithm>
#include <cstddef>

#include "ppu/matching/rotation.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Sets mass, centre and velocity.
template <int Dimension>
void add_particles(const ppu::SoftBody<Dimension>& body, WholeBody<Dimension>& whole) {
  const auto masses = body.model().masses();
  const auto x = body.positions(), v = body.velocities();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double m = double{masses[i]};
    whole.mass += m;
    whole.centre += m * x[i].template cast<double>();
    whole.velocity += m * v[i].template cast<double>();
  }
  SC_ASSERT(whole.mass > 0, "a body of {} particles has a mass of {} kg", masses.size(), whole.mass);
  whole.centre /= whole.mass;
  whole.velocity /= whole.mass;
}

}  // namespace

WholeBody<3>::WholeBody(const ppu::SoftBody<3>& body, const HeldRest<3>& rest) {
  add_particles(body, *this);
  const auto masses = body.model().masses();
  const auto x = body.positions(), v = body.velocities();
  Matrix3d second = Matrix3d::Zero();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double m = double{masses[i]};
    const Vector3d r = x[i].cast<double>() - centre;
    angular_momentum += m * r.cross(Vector3d(v[i].cast<double>()));
    second += m * r * r.transpose();
    correlation += m * r * rest.positions[i].cast<double>().transpose();
  }
  // This lets a body that is flat or lies on a line turn about all axes as well.
  constexpr double kThickness = 1e-3;
  const Matrix3d inertia = second.trace() * (1 + kThickness) * Matrix3d::Identity() - second;
  inverse_inertia = inertia.inverse();
}

Matrix3d WholeBody<3>::response_at(const Vector3d& r) const {
  Matrix3d cross;
  cross << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return Matrix3d::Identity() / mass - cross * inverse_inertia * cross;
}

Vector3d WholeBody<3>::turned(const Vector3d& from_centre_at_rest, Orientation& orientation) const {
  return ppu::update_rotation(correlation, orientation) * from_centre_at_rest;
}

WholeBody<2>::WholeBody(const ppu::SoftBody<2>& body, const HeldRest<2>& rest) {
  add_particles(body, *this);
  const auto masses = body.model().masses();
  const auto x = body.positions(), v = body.velocities();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double m = double{masses[i]};
    const Vector2d r = x[i].cast<double>() - centre;
    const Vector2d at_rest = rest.positions[i].cast<double>();
    inertia += m * r.squaredNorm();
    angular_momentum += m * across(r).dot(v[i].cast<double>());
    correlation += m * Vector2d(at_rest.dot(r), across(at_rest).dot(r));
  }
  // This lets a body without extent turn as well.
  constexpr double kLeast = 1e-3;  // of the inertia that the whole mass would have at a distance of one cell
  const double spacing = double{body.model().lattice().spacing};
  inertia = std::max(inertia, kLeast * mass * spacing * spacing);
}

Vector2d WholeBody<2>::turned(const Vector2d& from_centre_at_rest, Orientation&) const {
  const double length = correlation.norm();
  if (!(length > 0)) return from_centre_at_rest;
  const Vector2d along = correlation / length;
  return along.x() * from_centre_at_rest + along.y() * across(from_centre_at_rest);
}

}  // namespace softcell::demos
