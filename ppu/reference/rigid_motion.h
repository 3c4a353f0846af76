#pragma once
// The rigid motion of a region, in two dimensions and in three: what a particle adds to a region's sums, what
// a region makes of its sums, and what a particle makes of the sums that come down. Letters as in
// shape_matching.h; p = m~ x is a particle's moment, c the region's centre, c0 its rest centre.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "ppu/matching/lanes.h"
#include "ppu/matching/matching_plan.h"
#include "ppu/matching/rotation.h"

namespace softcell::ppu {

template <typename Real, int kDimension>
struct RigidMotion;

/// In two dimensions a rotation is one angle and has a closed form, so that two of the four sums of a region's
/// matrix are enough:
///
///     C = sum m~ p.q     S = sum m~ q x p     (cos, sin) ~ (C, S)
///
/// with p = x - c, q = x0 - c0, a x b = ax by - ay bx. That is the best rotation whatever the region's rank,
/// mirrored or not.
template <typename Real>
struct RigidMotion<Real, 2> {
  using Vector = Eigen::Matrix<Real, 2, 1>;
  using Region = typename MatchingPlan<Real, 2>::Region;
  using Rotation = Vector;         ///< cos and sin of the angle: where the region's x axis points
  using Moments = Lanes<Real, 4>;  ///< goes up: m~x, m~ x.x0, m~ x0 x x; for damping m~v, x x m~v, m~ |x|^2
  using Motion = Lanes<Real, 4>;   ///< comes down: t, cos, sin
  using Twist = Lanes<Real, 4>;    ///< comes down for damping: b, omega, a spare lane

  static Rotation unturned() { return {1, 0}; }

  static Real cross(const Vector& a, const Vector& b) { return a.x() * b.y() - a.y() * b.x(); }

  /// m~x, m~ x.x0, m~ x0 x x
  static Moments moments(const Vector& p, const Vector& x0) {
    return {{p.x(), p.y(), p.x() * x0.x() + p.y() * x0.y(), cross(x0, p)}};
  }

  /// C = sum3 - P.c0, S = sum4 - c0 x P, t = c - R c0. The rotation stays where the region has none of its
  /// own.
  static Motion motion(const Moments& sum, const Region& region, const Vector& c, Real noise_floor,
                       bool /*cold*/, Rotation& rotation) {
    const Vector& c0 = region.c0;
    const Vector p(sum[0], sum[1]);
    const Real cosine = sum[2] - (p.x() * c0.x() + p.y() * c0.y());
    const Real sine = sum[3] - cross(c0, p);
    const Real length = std::sqrt(cosine * cosine + sine * sine);
    if (length > region.mass * noise_floor) rotation = Rotation(cosine / length, sine / length);
    const Real cos = rotation.x(), sin = rotation.y();
    return {{c.x() - (cos * c0.x() - sin * c0.y()), c.y() - (sin * c0.x() + cos * c0.y()), cos, sin}};
  }

  /// sum t + (sum R) x0
  static Vector moved(const Motion& sum, const Vector& x0) {
    return {sum[0] + (sum[2] * x0.x() - sum[3] * x0.y()), sum[1] + (sum[3] * x0.x() + sum[2] * x0.y())};
  }

  /// m~v, x x m~v, m~ |x|^2
  static Moments momenta(Real mass, const Vector& x, const Vector& v) {
    const Vector p = mass * v;
    return {{p.x(), p.y(), cross(x, p), mass * (x.x() * x.x() + x.y() * x.y())}};
  }

  /// omega = (L - c x P) / (I - M |c|^2), b = v - omega x c
  static Twist twist(const Moments& sum, const Region& region, const Vector& c, Real noise_floor) {
    const Vector p(sum[0], sum[1]);
    const Real inertia = sum[3] - region.mass * (c.x() * c.x() + c.y() * c.y());
    const Real omega = inertia > region.mass * noise_floor ? (sum[2] - cross(c, p)) / inertia : Real(0);
    const Vector velocity = region.inverse_mass * p;
    return {{velocity.x() + omega * c.y(), velocity.y() - omega * c.x(), omega, 0}};
  }

  /// sum b + (sum omega) x x
  static Vector velocity(const Twist& sum, const Vector& x) {
    return {sum[0] - sum[2] * x.y(), sum[1] + sum[2] * x.x()};
  }
};

template <typename Real>
struct RigidMotion<Real, 3> {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  using Region = typename MatchingPlan<Real, 3>::Region;
  using Rotation = Eigen::Quaternion<Real>;
  using Moments = Lanes<Real, 12>;  ///< goes up: m~x and m~x x0^T; for damping m~v, x × m~v, m~x x^T
  using Motion = Lanes<Real, 12>;   ///< comes down: t and R
  using Twist = Lanes<Real, 8>;     ///< comes down for damping: b, omega, two spare lanes

  static Rotation unturned() { return Rotation::Identity(); }

  static Vector cross(const Vector& a, const Vector& b) {
    return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
  }

  /// m~x, m~x x0^T
  static Moments moments(const Vector& p, const Vector& x0) {
    return {{p.x(), p.y(), p.z(),                             //
             p.x() * x0.x(), p.x() * x0.y(), p.x() * x0.z(),  //
             p.y() * x0.x(), p.y() * x0.y(), p.y() * x0.z(),  //
             p.z() * x0.x(), p.z() * x0.y(), p.z() * x0.z()}};
  }

  /// A = sum m~x x0^T - P c0^T, t = c - R c0
  /// @param cold  the rotation says nothing about the region yet
  static Motion motion(const Moments& sum, const Region& region, const Vector& c, Real noise_floor, bool cold,
                       Rotation& rotation) {
    const Vector& c0 = region.c0;
    Matrix a;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) a(i, j) = sum[3 + 3 * i + j] - sum[i] * c0[j];
    const Real floor = region.mass * noise_floor;
    const Matrix r = cold ? find_rotation(a, rotation, floor) : update_rotation(a, rotation, floor);
    Motion motion;
    for (int i = 0; i < 3; ++i) {
      motion[i] = c[i] - (r(i, 0) * c0.x() + r(i, 1) * c0.y() + r(i, 2) * c0.z());
      for (int j = 0; j < 3; ++j) motion[3 + 3 * i + j] = r(i, j);
    }
    return motion;
  }

  /// sum t + (sum R) x0
  static Vector moved(const Motion& sum, const Vector& x0) {
    return {sum[0] + (sum[3] * x0.x() + sum[4] * x0.y() + sum[5] * x0.z()),
            sum[1] + (sum[6] * x0.x() + sum[7] * x0.y() + sum[8] * x0.z()),
            sum[2] + (sum[9] * x0.x() + sum[10] * x0.y() + sum[11] * x0.z())};
  }

  /// m~v, x × m~v, m~x x^T
  static Moments momenta(Real mass, const Vector& x, const Vector& v) {
    const Vector p = mass * v;
    const Vector l = cross(x, p);
    const Vector q = mass * x;
    return {{p.x(), p.y(), p.z(), l.x(), l.y(), l.z(),     //
             q.x() * x.x(), q.x() * x.y(), q.x() * x.z(),  //
             q.y() * x.y(), q.y() * x.z(), q.z() * x.z()}};
  }

  /// L = sum x × m~v - c × P, C = sum m~x x^T - M c c^T, omega = I^+ L, b = v - omega × c
  static Twist twist(const Moments& sum, const Region& region, const Vector& c, Real noise_floor) {
    const Vector p(sum[0], sum[1], sum[2]);
    const Vector l = Vector(sum[3], sum[4], sum[5]) - cross(c, p);
    const Vector q = region.mass * c;
    const Real second[6] = {sum[6] - q.x() * c.x(), sum[7] - q.x() * c.y(),  sum[8] - q.x() * c.z(),
                            sum[9] - q.y() * c.y(), sum[10] - q.y() * c.z(), sum[11] - q.z() * c.z()};
    const Vector omega = angular_velocity(second, l, region.mass * noise_floor);
    const Vector b = region.inverse_mass * p - cross(omega, c);
    return {{b.x(), b.y(), b.z(), omega.x(), omega.y(), omega.z(), 0, 0}};
  }

  /// sum b + (sum omega) × x
  static Vector velocity(const Twist& sum, const Vector& x) {
    return Vector(sum[0], sum[1], sum[2]) + cross(Vector(sum[3], sum[4], sum[5]), x);
  }

  /// omega = I^+ L, for I = trace(C) 1 - C and C (xx, xy, xz, yy, yz, zz) the region's second moment about its
  /// centre. Particles on one line have no inertia about it, but no angular momentum either: the shift only
  /// keeps the pivots from vanishing. On one point there is no rotation to speak of.
  static Vector angular_velocity(const Real (&c)[6], const Vector& l, Real least_trace) {
    constexpr Real kShift = 16 * std::numeric_limits<Real>::epsilon();
    const Real trace = c[0] + c[3] + c[5];
    if (!(trace > least_trace)) return Vector::Zero();
    const Real shift = kShift * trace;
    const Real i00 = c[3] + c[5] + shift, i11 = c[0] + c[5] + shift, i22 = c[0] + c[3] + shift;
    const Real i10 = -c[1], i20 = -c[2], i21 = -c[4];
    // I = L D L^T.
    const Real d0 = i00;
    const Real l10 = i10 / d0, l20 = i20 / d0;
    const Real d1 = i11 - l10 * i10;
    const Real l21 = (i21 - l20 * i10) / d1;
    const Real d2 = i22 - l20 * i20 - l21 * l21 * d1;
    if (!(d0 > shift / 2 && d1 > shift / 2 && d2 > shift / 2)) return Vector::Zero();
    const Real uy = l.y() - l10 * l.x(), uz = l.z() - l20 * l.x() - l21 * uy;
    const Real z = uz / d2, y = uy / d1 - l21 * z, x = l.x() / d0 - l10 * y - l20 * z;
    return {x, y, z};
  }
};

}  // namespace softcell::ppu
