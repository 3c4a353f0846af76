#include "ppu/reference/eigen_solver.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <type_traits>

#include "ppu/matching/rotation.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Matrix2f;
using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

// In two dimensions.

float cross(const Vector2f& a, const Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }
Vector2f cross(float omega, const Vector2f& x) { return omega * Vector2f(-x.y(), x.x()); }
float second_moment(float mass, const Vector2f& x) { return mass * x.squaredNorm(); }

Matrix2f best_rotation(const Matrix2f& a, EigenTypes<2>::Attitude&) {
  return Eigen::Rotation2Df(std::atan2(a(1, 0) - a(0, 1), a.trace())).toRotationMatrix();
}

/// @param inertia  about the centre.
float spin(float inertia, float momentum) { return inertia > 0 ? momentum / inertia : 0; }

// In three.

Vector3f cross(const Vector3f& a, const Vector3f& b) { return a.cross(b); }
Matrix3f second_moment(float mass, const Vector3f& x) { return mass * x * x.transpose(); }

Matrix3f best_rotation(const Matrix3f& a, Quaternionf& attitude) {
  return update_rotation<float>(a, attitude);
}

/// @param second  moment about the centre.
Vector3f spin(const Matrix3f& second, const Vector3f& momentum) {
  const Matrix3f inertia = (1 + 2e-6f) * second.trace() * Matrix3f::Identity() - second;
  return inertia.ldlt().solve(momentum);
}

/// Bodies begin as they were made.
template <class Attitude>
Attitude no_turn() {
  if constexpr (std::is_same_v<Attitude, Quaternionf>) {
    return Quaternionf::Identity();
  } else {
    return {};
  }
}

}  // namespace

template <int Dimension>
auto EigenSolver<Dimension>::Moments::operator+=(const Moments& other) -> Moments& {
  p += other.p;
  a += other.a;
  return *this;
}

template <int Dimension>
auto EigenSolver<Dimension>::Momenta::operator+=(const Momenta& other) -> Momenta& {
  p += other.p;
  l += other.l;
  q += other.q;
  return *this;
}

template <int Dimension>
auto EigenSolver<Dimension>::Motion::operator+=(const Motion& other) -> Motion& {
  t += other.t;
  r += other.r;
  return *this;
}

template <int Dimension>
auto EigenSolver<Dimension>::Twist::operator+=(const Twist& other) -> Twist& {
  b += other.b;
  omega += other.omega;
  return *this;
}

template <int Dimension>
EigenSolver<Dimension>::EigenSolver(std::shared_ptr<const MatchingPlan<float, Dimension>> plan)
    : plan_((SC_ASSERT(plan != nullptr, "a solver without a plan"), std::move(plan))),
      particle_moments_(plan_->particles()),
      region_moments_(plan_->regions()),
      particle_momenta_(plan_->particles()),
      region_momenta_(plan_->regions()),
      motions_(plan_->regions()),
      motion_totals_(plan_->regions()),
      twists_(plan_->regions()),
      twist_totals_(plan_->regions()),
      centres_(plan_->regions()),
      attitudes_(plan_->regions(), no_turn<typename Types::Attitude>()),
      moments_scratch_(plan_->sums()),
      momenta_scratch_(plan_->sums()),
      motion_scratch_(plan_->sums()),
      twist_scratch_(plan_->sums()) {}

template <int Dimension>
void EigenSolver<Dimension>::step(std::span<const Vector> x, std::span<Vector> v, float alpha, float h,
                                  float damping) {
  SC_ASSERT(x.size() == plan_->particles() && v.size() == plan_->particles(),
            "{} positions and {} velocities of {} particles", x.size(), v.size(), plan_->particles());
  SC_ASSERT(h > 0, "a time step of {} s", h);
  SC_ASSERT(alpha >= 0 && alpha <= 1 && damping >= 0 && damping <= 1, "an alpha of {} and a damping of {}",
            alpha, damping);
  match(x, v, alpha / h);
  damp(x, v, damping);
}

template <int Dimension>
void EigenSolver<Dimension>::match(std::span<const Vector> x, std::span<Vector> v, float rate) {
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector p = particles[i].modified_mass * x[i];
    particle_moments_[i] = {p, p * particles[i].x0.transpose()};
  }
  sum_up<Moments>(plan_->sums(), particle_moments_, moments_scratch_, region_moments_);

  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Moments& sum = region_moments_[r];
    centres_[r] = regions[r].inverse_mass * sum.p;
    const Matrix a = sum.a - sum.p * regions[r].c0.transpose();
    const Matrix rotation = best_rotation(a, attitudes_[r]);
    motions_[r] = {centres_[r] - rotation * regions[r].c0, rotation};
  }
  sum_down<Motion>(plan_->sums(), motions_, motion_scratch_, motion_totals_);

  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Motion& sum = motion_totals_[region_of[i]];
    const Vector goal = particles[i].inverse_region_count * (sum.r * particles[i].x0 + sum.t);
    v[i] += rate * (goal - x[i]);
  }
}

template <int Dimension>
void EigenSolver<Dimension>::damp(std::span<const Vector> x, std::span<Vector> v, float damping) {
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const float mass = particles[i].modified_mass;
    const Vector p = mass * v[i];
    particle_momenta_[i] = {p, cross(x[i], p), second_moment(mass, x[i])};
  }
  sum_up<Momenta>(plan_->sums(), particle_momenta_, momenta_scratch_, region_momenta_);

  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Momenta& sum = region_momenta_[r];
    const Vector& c = centres_[r];
    const typename Types::SecondMoment about_centre = sum.q - second_moment(regions[r].mass, c);
    const typename Types::Spin omega = spin(about_centre, sum.l - cross(c, sum.p));
    twists_[r] = {regions[r].inverse_mass * sum.p - cross(omega, c), omega};
  }
  sum_down<Twist>(plan_->sums(), twists_, twist_scratch_, twist_totals_);

  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Twist& sum = twist_totals_[region_of[i]];
    const Vector rigid = sum.b + cross(sum.omega, x[i]);
    v[i] += damping * (particles[i].inverse_region_count * rigid - v[i]);
  }
}

template class EigenSolver<2>;
template class EigenSolver<3>;

}  // namespace softcell::ppu
