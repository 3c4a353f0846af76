#pragma once
// Rotation in two dimensions and three: cross products, and moments of inertia in kg m^2.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "ppu/numbers/cross.h"

namespace softcell::ppu::turning {

using ppu::cross;
template <typename Real>
Eigen::Vector2<Real> cross(Real omega, const Eigen::Vector2<Real>& r) {
  return omega * Eigen::Vector2<Real>(-r.y(), r.x());
}
inline double inertia_of(const Eigen::Matrix2d& second_moment) { return second_moment.trace(); }
inline double inverse(double inertia) { return 1 / inertia; }
inline float to_float(double axial) { return static_cast<float>(axial); }

template <typename Real>
Eigen::Vector3<Real> cross(const Eigen::Vector3<Real>& a, const Eigen::Vector3<Real>& b) {
  return a.cross(b);
}
inline Eigen::Matrix3d inertia_of(const Eigen::Matrix3d& second_moment) {
  return second_moment.trace() * Eigen::Matrix3d::Identity() - second_moment;
}
inline Eigen::Matrix3d inverse(const Eigen::Matrix3d& inertia) { return inertia.inverse(); }
inline Eigen::Vector3f to_float(const Eigen::Vector3d& axial) { return axial.cast<float>(); }

inline double dot(double a, double b) { return a * b; }
inline double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.dot(b); }
inline double length_of(double axial) { return std::abs(axial); }
inline double length_of(const Eigen::Vector3d& axial) { return axial.norm(); }

/// The angular velocity (rad/s) with this angular momentum; 0 for particles on one point or, in three dimensions, on one line.
inline double turn_of(double inertia, double spin) { return inertia > 0 ? spin / inertia : 0; }
inline Eigen::Vector3d turn_of(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& spin) {
  constexpr double kFlat = 1e-9;
  const double size = inertia.trace();
  if (!(inertia.determinant() > kFlat * size * size * size)) return Eigen::Vector3d::Zero();
  return inverse(inertia) * spin;
}

/// Angular momentum, or an angular velocity.
template <int kDimension>
using Axial = decltype(cross(Eigen::Vector<double, kDimension>(), Eigen::Vector<double, kDimension>()));

}  // namespace softcell::ppu::turning
