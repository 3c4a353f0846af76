#include "ppu/bodies/lost_momenta.h"

#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

bool is_finite(double spin) { return std::isfinite(spin); }
bool is_finite(const Eigen::Vector3d& spin) { return spin.allFinite(); }

/// The turn (rad/s) with that spin; none for what lies on a point or, in three dimensions, on a line.
double turn_of(double inertia, double spin) { return inertia > 0 ? spin / inertia : 0; }
Eigen::Vector3d turn_of(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& spin) {
  constexpr double kFlat = 1e-9;
  const double size = inertia.trace();
  if (!(inertia.determinant() > kFlat * size * size * size)) return Eigen::Vector3d::Zero();
  return turning::inverse(inertia) * spin;
}

}  // namespace

template <int kDimension>
void LostMomenta<kDimension>::count(std::span<const Vector> positions, std::span<const float> masses,
                                    std::span<const Vector> before, std::span<Vector> after) {
  SC_ASSERT(masses.size() == positions.size() && before.size() == positions.size() &&
                after.size() == positions.size(),
            "{} positions, {} masses, {} and {} velocities", positions.size(), masses.size(), before.size(),
            after.size());
  Double momentum = Double::Zero();
  Axial spin = no_spin();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Double lost = double{masses[i]} * (before[i] - after[i]).template cast<double>();
    momentum += lost;
    spin += turning::cross(Double(positions[i].template cast<double>()), lost);
  }
  if (!momentum.allFinite() || !is_finite(spin)) return forget();  // velocities overflow
  momentum_ += momentum;
  spin_ += spin;
  if (++steps_ < kSteps) return;
  steps_ = 0;
  give_back(positions, masses, after);
}

template <int kDimension>
void LostMomenta<kDimension>::give_back(std::span<const Vector> positions, std::span<const float> masses,
                                        std::span<Vector> velocities) {
  double mass = 0;
  Double centre = Double::Zero();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    mass += double{masses[i]};
    centre += double{masses[i]} * positions[i].template cast<double>();
  }
  centre /= mass;
  Eigen::Matrix<double, kDimension, kDimension> second_moment;
  second_moment.setZero();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Double arm = positions[i].template cast<double>() - centre;
    second_moment += double{masses[i]} * arm * arm.transpose();
  }
  const Double velocity = momentum_ / mass;
  const Axial turn = turn_of(turning::inertia_of(second_moment),
                             Axial(spin_ - turning::cross(centre, Double(momentum_))));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Double x = positions[i].template cast<double>();
    const Vector was = velocities[i];
    velocities[i] += (velocity + turning::cross(turn, Double(x - centre))).template cast<float>();
    const Double given = double{masses[i]} * (velocities[i] - was).template cast<double>();
    momentum_ -= given;
    spin_ -= turning::cross(x, given);
  }
}

template class LostMomenta<2>;
template class LostMomenta<3>;

}  // namespace softcell::ppu
