#include "ppu/reference/shape_matching.h"

#include <algorithm>
#include <utility>

#include "ppu/reference/matching_checks.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

template <typename Real, int kDimension>
ShapeMatcher<Real, kDimension>::ShapeMatcher(std::shared_ptr<const MatchingPlan<Real, kDimension>> plan,
                                             SumMethod method)
    : plan_((SC_ASSERT(plan != nullptr, "a shape matcher without a plan"), std::move(plan))),
      method_(method),
      rotations_(plan_->regions(), Rigid::unturned()),
      x_(plan_->particles()),
      pulls_(plan_->particles()),
      centres_(plan_->regions()),
      particle_moments_(plan_->particles()),
      region_moments_(plan_->regions()),
      motions_(plan_->regions()),
      motion_totals_(plan_->regions()),
      twists_(plan_->regions()),
      twist_totals_(plan_->regions()),
      motion_scratch_(plan_->sums()),
      twist_scratch_(plan_->sums()) {}

template <typename Real, int kDimension>
void ShapeMatcher<Real, kDimension>::reset() {
  cold_ = true;
  std::fill(rotations_.begin(), rotations_.end(), Rigid::unturned());
}

template <typename Real, int kDimension>
void ShapeMatcher<Real, kDimension>::take_rotations(const ShapeMatcher& whole,
                                                    std::span<const std::uint32_t> particle_of) {
  const auto region_of = plan_->sums().region_of(), region_of_whole = whole.plan_->sums().region_of();
  SC_ASSERT(particle_of.size() == region_of.size(), "{} particles of {}", particle_of.size(),
            region_of.size());
  for (std::size_t i = 0; i < region_of.size(); ++i)
    rotations_[region_of[i]] = whole.rotations_[region_of_whole[particle_of[i]]];
  cold_ = whole.cold_;
}

template <typename Real, int kDimension>
void ShapeMatcher<Real, kDimension>::set_plan(std::shared_ptr<const MatchingPlan<Real, kDimension>> plan) {
  SC_ASSERT(plan != nullptr && plan->particles() == x_.size() && plan->regions() == rotations_.size(),
            "not a plan of {} particles and {} regions", x_.size(), rotations_.size());
  plan_ = std::move(plan);
}

template <typename Real, int kDimension>
void ShapeMatcher<Real, kDimension>::goals(std::span<const Vector> x, std::span<Vector> g) {
  check_sizes(plan_->particles(), x.size(), g.size());
  match(x);
  for (std::size_t i = 0; i < g.size(); ++i) g[i] = x[i] + pulls_[i];
}

template <typename Real, int kDimension>
void ShapeMatcher<Real, kDimension>::step_velocities(std::span<const Vector> x, std::span<Vector> v,
                                                     Real alpha, Real h, Real damping) {
  check_sizes(plan_->particles(), x.size(), v.size());
  check_step(static_cast<double>(alpha), static_cast<double>(damping), static_cast<double>(h));
  finite_mean<Vector>(v, "velocity");

  match(x);
  const Real rate = alpha / h;
  for (std::size_t i = 0; i < v.size(); ++i) v[i] += rate * pulls_[i];
  if (damping > 0) damp(v, damping);
}

template <typename Real, int kDimension>
void ShapeMatcher<Real, kDimension>::match(std::span<const Vector> x) {
  SC_ASSERT(x.size() == plan_->particles(), "{} positions of {} particles", x.size(), plan_->particles());
  localise<Vector>(x, plan_->spacing(), x_);

  // Per particle: m~x and its moments with x0.
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector p = particles[i].modified_mass * x_[i];
    particle_moments_[i] = Rigid::moments(p, particles[i].x0);
  }
  up();

  // Per region: c_r = P / M_r, R_r, t_r = c_r - R_r c0_r.
  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    Vector p;
    for (int d = 0; d < kDimension; ++d) p[d] = region_moments_[r][static_cast<std::size_t>(d)];
    centres_[r] = regions[r].inverse_mass * p;
    motions_[r] = Rigid::motion(region_moments_[r], regions[r], centres_[r], plan_->noise_floor(), cold_,
                                rotations_[r]);
  }
  cold_ = false;
  down(motions_, motion_scratch_, motion_totals_);

  // Per particle: g_i = (1 / |R_i|) (sum R_r x0_i + sum t_r).
  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector sum = Rigid::moved(motion_totals_[region_of[i]], particles[i].x0);
    pulls_[i] = particles[i].inverse_region_count * sum - x_[i];
  }
}

template <typename Real, int kDimension>
void ShapeMatcher<Real, kDimension>::damp(std::span<Vector> v, Real damping) {
  SC_ASSERT(damping > 0 && damping <= 1, "a damping of {}", damping);
  // Per particle: m~v, x × m~v, and the second moment m~x x^T or, in two dimensions, its trace.
  const auto particles = plan_->particle_constants();
  for (std::size_t i = 0; i < particles.size(); ++i)
    particle_moments_[i] = Rigid::momenta(particles[i].modified_mass, x_[i], v[i]);
  up();

  // Per region: v_r = P / M_r, omega_r = I_r^+ L_r, b_r = v_r - omega_r × c_r.
  const auto regions = plan_->region_constants();
  for (std::size_t r = 0; r < regions.size(); ++r)
    twists_[r] = Rigid::twist(region_moments_[r], regions[r], centres_[r], plan_->noise_floor());
  down(twists_, twist_scratch_, twist_totals_);

  // Per particle: dv_i = (1 / |R_i|) (sum b_r + (sum omega_r) × x_i) - v_i.
  const auto region_of = plan_->sums().region_of();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vector moving = Rigid::velocity(twist_totals_[region_of[i]], x_[i]);
    v[i] += damping * (particles[i].inverse_region_count * moving - v[i]);
  }
}

template <typename Real, int kDimension>
void ShapeMatcher<Real, kDimension>::up() {
  const SumPlan& sums = plan_->sums();
  if (method_ == SumMethod::kNaive)
    sum_up_naively<Moments>(sums, particle_moments_, region_moments_);
  else
    sum_up<Moments>(sums, particle_moments_, motion_scratch_, region_moments_);
}

template <typename Real, int kDimension>
template <typename Payload>
void ShapeMatcher<Real, kDimension>::down(const std::vector<Payload>& values, SumScratch<Payload>& scratch,
                                          std::vector<Payload>& totals) {
  const SumPlan& sums = plan_->sums();
  if (method_ == SumMethod::kNaive)
    sum_down_naively<Payload>(sums, values, totals);
  else
    sum_down<Payload>(sums, values, scratch, totals);
}

template class ShapeMatcher<float, 2>;
template class ShapeMatcher<double, 2>;
template class ShapeMatcher<float, 3>;
template class ShapeMatcher<double, 3>;

}  // namespace softcell::ppu
