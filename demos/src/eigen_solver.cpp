#include "eigen_solver.h"

#include <Eigen/Cholesky>

#include "softcell/ppu/rotation.h"

namespace softcell::demos {

using Eigen::Matrix3f;
using Eigen::Vector3f;

EigenSolver::Moments& EigenSolver::Moments::operator+=(const Moments& other) {
  p += other.p;
  a += other.a;
  return *this;
}

EigenSolver::Momenta& EigenSolver::Momenta::operator+=(const Momenta& other) {
  p += other.p;
  l += other.l;
  q += other.q;
  return *this;
}

EigenSolver::Motion& EigenSolver::Motion::operator+=(const Motion& other) {
  t += other.t;
  r += other.r;
  return *this;
}

EigenSolver::Twist& EigenSolver::Twist::operator+=(const Twist& other) {
  b += other.b;
  omega += other.omega;
  return *this;
}

EigenSolver::EigenSolver(std::shared_ptr<const ppu::MatchingPlan<float>> plan)
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
      rotations_(plan_->regions(), Eigen::Quaternionf::Identity()),
      moments_scratch_(plan_->sums()),
      momenta_scratch_(plan_->sums()),
      motion_scratch_(plan_->sums()),
      twist_scratch_(plan_->sums()) {}

void EigenSolver::step(std::span<const Vector3f> x, std::span<Vector3f> v, float alpha, float h,
                       float damping) {
  match(x, v, alpha / h);
  damp(x, v, damping);
}

void EigenSolver::match(std::span<const Vector3f> x, std::span<Vector3f> v, float rate) {
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector3f p = particles[i].modified_mass * x[i];
    particle_moments_[i] = {p, p * particles[i].x0.transpose()};
  }
  ppu::sum_up<Moments>(plan_->sums(), particle_moments_, moments_scratch_, region_moments_);

  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Moments& sum = region_moments_[r];
    centres_[r] = regions[r].inverse_mass * sum.p;
    const Matrix3f a = sum.a - sum.p * regions[r].c0.transpose();
    const Matrix3f rotation = ppu::update_rotation<float>(a, rotations_[r]);
    motions_[r] = {centres_[r] - rotation * regions[r].c0, rotation};
  }
  ppu::sum_down<Motion>(plan_->sums(), motions_, motion_scratch_, motion_totals_);

  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Motion& sum = motion_totals_[region_of[i]];
    const Vector3f goal = particles[i].inverse_region_count * (sum.r * particles[i].x0 + sum.t);
    v[i] += rate * (goal - x[i]);
  }
}

void EigenSolver::damp(std::span<const Vector3f> x, std::span<Vector3f> v, float damping) {
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector3f p = particles[i].modified_mass * v[i];
    particle_momenta_[i] = {p, x[i].cross(p), particles[i].modified_mass * x[i] * x[i].transpose()};
  }
  ppu::sum_up<Momenta>(plan_->sums(), particle_momenta_, momenta_scratch_, region_momenta_);

  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Momenta& sum = region_momenta_[r];
    const Vector3f& c = centres_[r];
    const Matrix3f second = sum.q - regions[r].mass * c * c.transpose();
    const Matrix3f inertia = (1 + 2e-6f) * second.trace() * Matrix3f::Identity() - second;
    const Vector3f omega = inertia.ldlt().solve(sum.l - c.cross(sum.p));
    twists_[r] = {regions[r].inverse_mass * sum.p - omega.cross(c), omega};
  }
  ppu::sum_down<Twist>(plan_->sums(), twists_, twist_scratch_, twist_totals_);

  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Twist& sum = twist_totals_[region_of[i]];
    v[i] += damping * (particles[i].inverse_region_count * (sum.b + sum.omega.cross(x[i])) - v[i]);
  }
}

}  // namespace softcell::demos
