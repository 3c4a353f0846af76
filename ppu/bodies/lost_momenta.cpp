#include "ppu/bodies/lost_momenta.h"

#include <cmath>
#include <type_traits>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// A particle's vector in one register, which has room for four numbers: in three dimensions the fourth is unused and may be anything.
template <int kDimension>
using InRegister = std::conditional_t<kDimension == 3, Eigen::Vector4f, Eigen::Vector2f>;

template <int kDimension>
InRegister<kDimension> in_register(std::span<const Eigen::Vector<float, kDimension>> vectors, std::size_t i) {
  if constexpr (kDimension == 3) {
    if (i + 1 == vectors.size()) return {vectors[i].x(), vectors[i].y(), vectors[i].z(), 0};
    return Eigen::Map<const Eigen::Vector4f>(vectors[i].data());
  } else {
    return vectors[i];
  }
}

template <int kDimension>
Eigen::Vector<float, kDimension> narrow(const InRegister<kDimension>& vector) {
  return vector.template head<kDimension>();
}

/// Sums of d and of r d^T over particles: in floats over a few, in doubles over all.
template <int kDimension>
class Moments {
 public:
  using Double = Eigen::Vector<double, kDimension>;
  using Matrix = Eigen::Matrix<double, kDimension, kDimension>;

  void add(const InRegister<kDimension>& r, const InRegister<kDimension>& d) {
    first_ += d;
    for (int k = 0; k < kDimension; ++k) second_[k] += r * d[k];
    if (++added_ == kAtOnce) carry();
  }
  const Double& first() {
    carry();
    return sum_;
  }
  const Matrix& second() {
    carry();
    return matrix_;
  }
  /// The sum of r x d.
  turning::Axial<kDimension> spin() {
    const Matrix& m = second();
    if constexpr (kDimension == 3)
      return {m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0)};
    else
      return m(0, 1) - m(1, 0);
  }

 private:
  static constexpr int kAtOnce = 32;
  static InRegister<kDimension> zero() { return InRegister<kDimension>::Zero(); }

  void carry() {
    sum_ += narrow<kDimension>(first_).template cast<double>();
    first_ = zero();
    for (int k = 0; k < kDimension; ++k) {
      matrix_.col(k) += narrow<kDimension>(second_[k]).template cast<double>();
      second_[k] = zero();
    }
    added_ = 0;
  }

  InRegister<kDimension> first_ = zero();
  InRegister<kDimension> second_[3] = {zero(), zero(), zero()};
  int added_ = 0;
  Double sum_ = Double::Zero();
  Matrix matrix_ = Matrix::Zero();
};

bool is_finite(double spin) { return std::isfinite(spin); }
bool is_finite(const Eigen::Vector3d& spin) { return spin.allFinite(); }

/// Sets columns so that velocity = sum of column k times arm k.
void set_columns(InRegister<2> (&columns)[3], double turn) {
  const auto omega = static_cast<float>(turn);
  columns[0] = {0, omega};
  columns[1] = {-omega, 0};
}
void set_columns(InRegister<3> (&columns)[3], const Eigen::Vector3d& turn) {
  const Eigen::Vector3f omega = turn.cast<float>();
  columns[0] = {0, omega.z(), -omega.y(), 0};
  columns[1] = {-omega.z(), 0, omega.x(), 0};
  columns[2] = {omega.y(), -omega.x(), 0, 0};
}

}  // namespace

template <int kDimension>
void LostMomenta<kDimension>::count(std::span<const Vector> positions, std::span<const float> masses,
                                    std::span<const Vector> before, std::span<Vector> after) {
  SC_ASSERT(!positions.empty() && masses.size() == positions.size() && before.size() == positions.size() &&
                after.size() == positions.size(),
            "{} positions, {} masses, {} and {} velocities", positions.size(), masses.size(), before.size(),
            after.size());
  // Arms start at a point of the body, so that they are as exact far from the origin as near it.
  const InRegister<kDimension> middle = in_register<kDimension>(positions, positions.size() / 2);
  const std::span<const Vector> now = after;
  Moments<kDimension> lost;
  for (std::size_t i = 0; i < positions.size(); ++i)
    lost.add(in_register<kDimension>(positions, i) - middle,
             masses[i] * (in_register<kDimension>(before, i) - in_register<kDimension>(now, i)));
  const Double momentum = lost.first();
  const Axial spin = lost.spin();
  if (!momentum.allFinite() || !is_finite(spin)) return forget();  // velocities overflow
  momentum_ += momentum;
  spin_ += spin + turning::cross(Double(narrow<kDimension>(middle).template cast<double>()), momentum);
  if (++steps_ < kSteps) return;
  steps_ = 0;
  give_back(positions, masses, after);
}

template <int kDimension>
void LostMomenta<kDimension>::give_back(std::span<const Vector> positions, std::span<const float> masses,
                                        std::span<Vector> velocities) {
  const InRegister<kDimension> middle = in_register<kDimension>(positions, positions.size() / 2);
  double mass = 0;
  Moments<kDimension> body;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const InRegister<kDimension> arm = in_register<kDimension>(positions, i) - middle;
    body.add(arm, masses[i] * arm);
    mass += double{masses[i]};
  }
  // About the centre of mass, whose position is relative to `middle`.
  const Double centre = body.first() / mass, origin = narrow<kDimension>(middle).template cast<double>();
  const Double velocity = momentum_ / mass;
  const Axial spin = spin_ - turning::cross(Double(origin + centre), momentum_);
  const typename Moments<kDimension>::Matrix about_centre =
      body.second() - mass * centre * centre.transpose();
  const Axial turn = turning::turn_of(turning::inertia_of(about_centre), spin);

  const Double at_middle = velocity - turning::cross(turn, centre);
  InRegister<kDimension> steady = InRegister<kDimension>::Zero(), columns[3];
  steady.template head<kDimension>() = at_middle.template cast<float>();
  set_columns(columns, turn);
  Moments<kDimension> given;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const InRegister<kDimension> arm = in_register<kDimension>(positions, i) - middle;
    InRegister<kDimension> by = steady;
    for (int k = 0; k < kDimension; ++k) by += columns[k] * arm[k];
    const InRegister<kDimension> was = in_register<kDimension>(std::span<const Vector>(velocities), i),
                                 is = was + by;
    velocities[i] = narrow<kDimension>(is);
    given.add(arm, masses[i] * (is - was));
  }
  momentum_ -= given.first();
  spin_ -= given.spin() + turning::cross(origin, given.first());
}

template <int kDimension>
void LostMomenta<kDimension>::inherit(const LostMomenta& whole, double share, const Double& from_centre) {
  SC_ASSERT(share > 0 && share <= 1, "a piece with {} of the whole's mass", share);
  momentum_ = share * whole.momentum_;
  spin_ = share * (whole.spin_ + turning::cross(from_centre, whole.momentum_));
  steps_ = whole.steps_;
}

template class LostMomenta<2>;
template class LostMomenta<3>;

}  // namespace softcell::ppu
