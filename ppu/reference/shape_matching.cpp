#include "ppu/reference/shape_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "ppu/matching/rotation.h"
#include "ppu/reference/matching_checks.h"

namespace softcell::ppu {

namespace {

template <typename Real>
using Vector3 = Eigen::Matrix<Real, 3, 1>;
template <typename Real>
using Matrix3 = Eigen::Matrix<Real, 3, 3>;

template <typename Real>
Vector3<Real> cross(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

/// R v + t.
template <typename Real>
Vector3<Real> transform(const Lanes<Real, 12>& motion, const Vector3<Real>& v) {
  return {motion[0] + (motion[3] * v.x() + motion[4] * v.y() + motion[5] * v.z()),
          motion[1] + (motion[6] * v.x() + motion[7] * v.y() + motion[8] * v.z()),
          motion[2] + (motion[9] * v.x() + motion[10] * v.y() + motion[11] * v.z())};
}

/// omega = I^+ L, for I = trace(C) 1 - C and C (xx, xy, xz, yy, yz, zz) the region's second moment about its
/// centre. Particles on one line have no inertia about it, but no angular momentum either: the shift only
/// keeps the pivots from vanishing. On one point there is no rotation to speak of.
template <typename Real>
Vector3<Real> angular_velocity(const Real (&c)[6], const Vector3<Real>& l, Real least_trace) {
  constexpr Real kShift = 16 * std::numeric_limits<Real>::epsilon();
  const Real trace = c[0] + c[3] + c[5];
  if (!(trace > least_trace)) return Vector3<Real>::Zero();
  const Real shift = kShift * trace;
  const Real i00 = c[3] + c[5] + shift, i11 = c[0] + c[5] + shift, i22 = c[0] + c[3] + shift;
  const Real i10 = -c[1], i20 = -c[2], i21 = -c[4];
  // I = L D L^T.
  const Real d0 = i00;
  const Real l10 = i10 / d0, l20 = i20 / d0;
  const Real d1 = i11 - l10 * i10;
  const Real l21 = (i21 - l20 * i10) / d1;
  const Real d2 = i22 - l20 * i20 - l21 * l21 * d1;
  if (!(d0 > shift / 2 && d1 > shift / 2 && d2 > shift / 2)) return Vector3<Real>::Zero();
  const Real uy = l.y() - l10 * l.x(), uz = l.z() - l20 * l.x() - l21 * uy;
  const Real z = uz / d2, y = uy / d1 - l21 * z, x = l.x() / d0 - l10 * y - l20 * z;
  return {x, y, z};
}

}  // namespace

template <typename Real>
ShapeMatcher<Real>::ShapeMatcher(std::shared_ptr<const MatchingPlan<Real>> plan, SumMethod method)
    : plan_(std::move(plan)),
      method_(method),
      rotations_(plan_->regions(), Quaternion::Identity()),
      x_(plan_->particles()),
      pulls_(plan_->particles()),
      goals_(plan_->particles()),
      centres_(plan_->regions()),
      particle_moments_(plan_->particles()),
      region_moments_(plan_->regions()),
      motions_(plan_->regions()),
      motion_totals_(plan_->regions()),
      twists_(plan_->regions()),
      twist_totals_(plan_->regions()),
      scratch12_(plan_->sums()),
      scratch8_(plan_->sums()) {
  for (std::size_t i = 0; i < goals_.size(); ++i)
    goals_[i] = plan_->rest_centre() + plan_->particle_constants()[i].x0;
}

template <typename Real>
void ShapeMatcher<Real>::reset() {
  cold_ = true;
  std::fill(rotations_.begin(), rotations_.end(), Quaternion::Identity());
}

template <typename Real>
void ShapeMatcher<Real>::goals(std::span<const Vector> x, std::span<Vector> g) {
  check_sizes(plan_->particles(), x.size(), g.size());
  match(x);
  std::copy(goals_.begin(), goals_.end(), g.begin());
}

template <typename Real>
void ShapeMatcher<Real>::step_velocities(std::span<const Vector> x, std::span<Vector> v, Real alpha, Real h,
                                         Real damping) {
  check_sizes(plan_->particles(), x.size(), v.size());
  check_step(static_cast<double>(alpha), static_cast<double>(damping), static_cast<double>(h));
  finite_mean<Vector>(v, "velocity");

  match(x);
  const Real rate = alpha / h;
  for (std::size_t i = 0; i < v.size(); ++i) v[i] += rate * pulls_[i];
  if (damping > 0) damp(v, damping);
}

template <typename Real>
void ShapeMatcher<Real>::match(std::span<const Vector> x) {
  localise<Vector>(x, plan_->spacing(), x_);

  // Per particle: m~x, m~x x0^T.
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector& x0 = particles[i].x0;
    const Vector p = particles[i].modified_mass * x_[i];
    particle_moments_[i] = {{p.x(), p.y(), p.z(),                             //
                             p.x() * x0.x(), p.x() * x0.y(), p.x() * x0.z(),  //
                             p.y() * x0.x(), p.y() * x0.y(), p.y() * x0.z(),  //
                             p.z() * x0.x(), p.z() * x0.y(), p.z() * x0.z()}};
  }
  up();

  // Per region: c_r = P / M_r, A_r = sum m~x x0^T - P c0_r^T, t_r = c_r - R_r c0_r.
  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Moments& sum = region_moments_[r];
    const Vector& c0 = regions[r].c0;
    const Vector c = regions[r].inverse_mass * Vector(sum[0], sum[1], sum[2]);
    Matrix3<Real> a;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) a(i, j) = sum[3 + 3 * i + j] - sum[i] * c0[j];
    const Real floor = regions[r].mass * plan_->noise_floor();
    const Matrix3<Real> rotation =
        cold_ ? find_rotation(a, rotations_[r], floor) : update_rotation(a, rotations_[r], floor);
    Motion& motion = motions_[r];
    for (int i = 0; i < 3; ++i) {
      motion[i] = c[i] - (rotation(i, 0) * c0.x() + rotation(i, 1) * c0.y() + rotation(i, 2) * c0.z());
      for (int j = 0; j < 3; ++j) motion[3 + 3 * i + j] = rotation(i, j);
    }
    centres_[r] = c;
  }
  cold_ = false;
  down(motions_, scratch12_, motion_totals_);

  // Per particle: g_i = (1 / |R_i|) (sum R_r x0_i + sum t_r).
  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector sum = transform(motion_totals_[region_of[i]], particles[i].x0);
    pulls_[i] = particles[i].inverse_region_count * sum - x_[i];
    goals_[i] = x[i] + pulls_[i];
  }
}

template <typename Real>
void ShapeMatcher<Real>::damp(std::span<Vector> v, Real damping) {
  // Per particle: m~v, x × m~v, m~x x^T.
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector& x = x_[i];
    const Vector p = particles[i].modified_mass * v[i];
    const Vector l = cross(x, p);
    const Vector q = particles[i].modified_mass * x;
    particle_moments_[i] = {{p.x(), p.y(), p.z(), l.x(), l.y(), l.z(),     //
                             q.x() * x.x(), q.x() * x.y(), q.x() * x.z(),  //
                             q.y() * x.y(), q.y() * x.z(), q.z() * x.z()}};
  }
  up();

  // Per region: v_r = P / M_r, L_r = sum x × m~v - c_r × P, C_r = sum m~x x^T - M_r c_r c_r^T, omega_r =
  // I_r^+ L_r.
  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Moments& sum = region_moments_[r];
    const Vector& c = centres_[r];
    const Vector p(sum[0], sum[1], sum[2]);
    const Vector l = Vector(sum[3], sum[4], sum[5]) - cross(c, p);
    const Vector q = regions[r].mass * c;
    const Real second[6] = {sum[6] - q.x() * c.x(), sum[7] - q.x() * c.y(),  sum[8] - q.x() * c.z(),
                            sum[9] - q.y() * c.y(), sum[10] - q.y() * c.z(), sum[11] - q.z() * c.z()};
    const Vector omega = angular_velocity(second, l, regions[r].mass * plan_->noise_floor());
    const Vector b = regions[r].inverse_mass * p - cross(omega, c);
    twists_[r] = {{b.x(), b.y(), b.z(), omega.x(), omega.y(), omega.z(), 0, 0}};
  }
  down(twists_, scratch8_, twist_totals_);

  // Per particle: dv_i = (1 / |R_i|) (sum b_r + (sum omega_r) × x_i) - v_i.
  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Twist& sum = twist_totals_[region_of[i]];
    const Vector moving = Vector(sum[0], sum[1], sum[2]) + cross(Vector(sum[3], sum[4], sum[5]), x_[i]);
    v[i] += damping * (particles[i].inverse_region_count * moving - v[i]);
  }
}

template <typename Real>
void ShapeMatcher<Real>::up() {
  const SumPlan& sums = plan_->sums();
  if (method_ == SumMethod::kNaive)
    sum_up_naively<Moments>(sums, particle_moments_, region_moments_);
  else
    sum_up<Moments>(sums, particle_moments_, scratch12_, region_moments_);
}

template <typename Real>
template <typename Payload>
void ShapeMatcher<Real>::down(const std::vector<Payload>& values, SumScratch<Payload>& scratch,
                              std::vector<Payload>& totals) {
  const SumPlan& sums = plan_->sums();
  if (method_ == SumMethod::kNaive)
    sum_down_naively<Payload>(sums, values, totals);
  else
    sum_down<Payload>(sums, values, scratch, totals);
}

template class ShapeMatcher<float>;
template class ShapeMatcher<double>;

}  // namespace softcell::ppu
