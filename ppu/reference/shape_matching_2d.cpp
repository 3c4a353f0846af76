#include "ppu/reference/shape_matching_2d.h"

#include <algorithm>
#include <cmath>

#include "ppu/reference/matching_checks.h"

namespace softcell::ppu {
namespace {

/// a x b.
template <typename Vector>
auto cross(const Vector& a, const Vector& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

template <typename Real>
ShapeMatcher2d<Real>::ShapeMatcher2d(std::shared_ptr<const MatchingPlan2d<Real>> plan, SumMethod method)
    : plan_(std::move(plan)),
      method_(method),
      directions_(plan_->regions(), Direction(1, 0)),
      x_(plan_->particles()),
      pulls_(plan_->particles()),
      centres_(plan_->regions()),
      of_particles_(plan_->particles()),
      of_regions_(plan_->regions()),
      totals_(plan_->regions()),
      scratch_(plan_->sums()) {}

template <typename Real>
void ShapeMatcher2d<Real>::reset() {
  std::fill(directions_.begin(), directions_.end(), Direction(1, 0));
}

template <typename Real>
void ShapeMatcher2d<Real>::goals(std::span<const Vector> x, std::span<Vector> g) {
  check_sizes(plan_->particles(), x.size(), g.size());
  match(x);
  for (std::size_t i = 0; i < g.size(); ++i) g[i] = x[i] + pulls_[i];
}

template <typename Real>
void ShapeMatcher2d<Real>::step_velocities(std::span<const Vector> x, std::span<Vector> v, Real alpha, Real h,
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
void ShapeMatcher2d<Real>::match(std::span<const Vector> x) {
  localise<Vector>(x, plan_->spacing(), x_);
  // Per particle: m~x, m~ x.x0, m~ x0 x x.
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector p = particles[i].modified_mass * x_[i];
    const Vector& x0 = particles[i].x0;
    of_particles_[i] = {{p.x(), p.y(), p.x() * x0.x() + p.y() * x0.y(), cross(x0, p)}};
  }
  up();

  // Per region: c = P / M, C = sum3 - P.c0, S = sum4 - c0 x P, t = c - R c0.
  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    Payload& sum = of_regions_[r];
    const Vector& c0 = regions[r].c0;
    const Vector p(sum[0], sum[1]);
    const Real cosine = sum[2] - (p.x() * c0.x() + p.y() * c0.y());
    const Real sine = sum[3] - cross(c0, p);
    const Real length = std::sqrt(cosine * cosine + sine * sine);
    Direction& direction = directions_[r];
    if (length > regions[r].mass * plan_->noise_floor())
      direction = Direction(cosine / length, sine / length);
    centres_[r] = regions[r].inverse_mass * p;
    const Real c = direction.x(), s = direction.y();
    sum = {{centres_[r].x() - (c * c0.x() - s * c0.y()), centres_[r].y() - (s * c0.x() + c * c0.y()), c, s}};
  }
  down();

  // Per particle: g = (sum t + (sum R) x0) / |R_i|.
  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Payload& sum = totals_[region_of[i]];
    const Vector& x0 = particles[i].x0;
    const Vector goal(sum[0] + (sum[2] * x0.x() - sum[3] * x0.y()),
                      sum[1] + (sum[3] * x0.x() + sum[2] * x0.y()));
    pulls_[i] = particles[i].inverse_region_count * goal - x_[i];
  }
}

template <typename Real>
void ShapeMatcher2d<Real>::damp(std::span<Vector> v, Real damping) {
  // Per particle: m~v, x x m~v, m~ |x|^2.
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector& x = x_[i];
    const Vector p = particles[i].modified_mass * v[i];
    of_particles_[i] = {
        {p.x(), p.y(), cross(x, p), particles[i].modified_mass * (x.x() * x.x() + x.y() * x.y())}};
  }
  up();

  // Per region: omega = (L - c x P) / (I - M |c|^2), and v_r - omega x c.
  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    Payload& sum = of_regions_[r];
    const Vector& c = centres_[r];
    const Vector p(sum[0], sum[1]);
    const Real inertia = sum[3] - regions[r].mass * (c.x() * c.x() + c.y() * c.y());
    const Real omega =
        inertia > regions[r].mass * plan_->noise_floor() ? (sum[2] - cross(c, p)) / inertia : Real(0);
    const Vector velocity = regions[r].inverse_mass * p;
    sum = {{velocity.x() + omega * c.y(), velocity.y() - omega * c.x(), omega, 0}};
  }
  down();

  // Per particle: dv = (sum b + (sum omega) x x) / |R_i| - v.
  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Payload& sum = totals_[region_of[i]];
    const Vector moving(sum[0] - sum[2] * x_[i].y(), sum[1] + sum[2] * x_[i].x());
    v[i] += damping * (particles[i].inverse_region_count * moving - v[i]);
  }
}

template <typename Real>
void ShapeMatcher2d<Real>::up() {
  if (method_ == SumMethod::kNaive)
    sum_up_naively<Payload>(plan_->sums(), of_particles_, of_regions_);
  else
    sum_up<Payload>(plan_->sums(), of_particles_, scratch_, of_regions_);
}

template <typename Real>
void ShapeMatcher2d<Real>::down() {
  if (method_ == SumMethod::kNaive)
    sum_down_naively<Payload>(plan_->sums(), of_regions_, totals_);
  else
    sum_down<Payload>(plan_->sums(), of_regions_, scratch_, totals_);
}

template class ShapeMatcher2d<float>;
template class ShapeMatcher2d<double>;

}  // namespace softcell::ppu
