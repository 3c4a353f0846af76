#include "eigen_solver_2d.h"

#include <cmath>

namespace softcell::demos {

using Eigen::Matrix2f;
using Eigen::Rotation2Df;
using Eigen::Vector2f;

namespace {

float cross(const Vector2f& a, const Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

EigenSolver2d::Moments& EigenSolver2d::Moments::operator+=(const Moments& other) {
  p += other.p;
  a += other.a;
  return *this;
}

EigenSolver2d::Momenta& EigenSolver2d::Momenta::operator+=(const Momenta& other) {
  p += other.p;
  l += other.l;
  inertia += other.inertia;
  return *this;
}

EigenSolver2d::Motion& EigenSolver2d::Motion::operator+=(const Motion& other) {
  t += other.t;
  r += other.r;
  return *this;
}

EigenSolver2d::Twist& EigenSolver2d::Twist::operator+=(const Twist& other) {
  b += other.b;
  omega += other.omega;
  return *this;
}

EigenSolver2d::EigenSolver2d(std::shared_ptr<const ppu::MatchingPlan2d<float>> plan)
    : plan_(std::move(plan)),
      particle_moments_(plan_->particles()),
      region_moments_(plan_->regions()),
      particle_momenta_(plan_->particles()),
      region_momenta_(plan_->regions()),
      motions_(plan_->regions()),
      motion_totals_(plan_->regions()),
      twists_(plan_->regions()),
      twist_totals_(plan_->regions()),
      centres_(plan_->regions()),
      moments_scratch_(plan_->sums()),
      momenta_scratch_(plan_->sums()),
      motion_scratch_(plan_->sums()),
      twist_scratch_(plan_->sums()) {}

void EigenSolver2d::step(std::span<const Vector2f> x, std::span<Vector2f> v, float alpha, float h,
                         float damping) {
  match(x, v, alpha / h);
  damp(x, v, damping);
}

void EigenSolver2d::match(std::span<const Vector2f> x, std::span<Vector2f> v, float rate) {
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector2f p = particles[i].modified_mass * x[i];
    particle_moments_[i] = {p, p * particles[i].x0.transpose()};
  }
  ppu::sum_up<Moments>(plan_->sums(), particle_moments_, moments_scratch_, region_moments_);

  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Moments& sum = region_moments_[r];
    centres_[r] = regions[r].inverse_mass * sum.p;
    const Matrix2f a = sum.a - sum.p * regions[r].c0.transpose();
    const Matrix2f rotation = Rotation2Df(std::atan2(a(1, 0) - a(0, 1), a.trace())).toRotationMatrix();
    motions_[r] = {centres_[r] - rotation * regions[r].c0, rotation};
  }
  ppu::sum_down<Motion>(plan_->sums(), motions_, motion_scratch_, motion_totals_);

  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Motion& sum = motion_totals_[region_of[i]];
    const Vector2f goal = particles[i].inverse_region_count * (sum.r * particles[i].x0 + sum.t);
    v[i] += rate * (goal - x[i]);
  }
}

void EigenSolver2d::damp(std::span<const Vector2f> x, std::span<Vector2f> v, float damping) {
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector2f p = particles[i].modified_mass * v[i];
    particle_momenta_[i] = {p, cross(x[i], p), particles[i].modified_mass * x[i].squaredNorm()};
  }
  ppu::sum_up<Momenta>(plan_->sums(), particle_momenta_, momenta_scratch_, region_momenta_);

  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Momenta& sum = region_momenta_[r];
    const Vector2f& c = centres_[r];
    const float inertia = sum.inertia - regions[r].mass * c.squaredNorm();
    const float omega = inertia > 0 ? (sum.l - cross(c, sum.p)) / inertia : 0;
    twists_[r] = {regions[r].inverse_mass * sum.p + omega * Vector2f(c.y(), -c.x()), omega};
  }
  ppu::sum_down<Twist>(plan_->sums(), twists_, twist_scratch_, twist_totals_);

  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Twist& sum = twist_totals_[region_of[i]];
    const Vector2f rigid = sum.b + sum.omega * Vector2f(-x[i].y(), x[i].x());
    v[i] += damping * (particles[i].inverse_region_count * rigid - v[i]);
  }
}

}  // namespace softcell::demos
