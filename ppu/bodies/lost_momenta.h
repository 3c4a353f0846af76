#pragma once
// Measures the momenta that a body loses by rounding in shape matching and damping, and returns them.
//
// Both act within a body, so its momentum and angular momentum should stay. They nearly do: iterations for the rotations of regions end
// slightly behind a body that rotates, and SPUs truncate. The loss in a step is about one bit of a float, but always in the same direction:
// in a thousand steps a body that only rotates loses 1/2000 of its angular momentum.
//
//     step    1      2      3      4             5  ...
//     lost    +      +      +      +  -> given back as one rigid motion; the rest, too small for floats, is kept for later

#include <Eigen/Core>
#include <span>

#include "ppu/numbers/turning.h"

namespace softcell::ppu {

/// The losses of one body. Used by one thread; allocates nothing.
template <int kDimension>
class LostMomenta {
 public:
  using Vector = Eigen::Vector<float, kDimension>;
  using Double = Eigen::Vector<double, kDimension>;

  /// Forgets all losses: the user has moved the body.
  void forget() { *this = {}; }

  /// Adds the losses in a step in which forces within the body have changed velocities. Every kSteps-th call returns them by changing
  /// `after`.
  /// @param positions  metres   @param masses  kg   @param before, after  m/s; each for all particles
  void count(std::span<const Vector> positions, std::span<const float> masses, std::span<const Vector> before,
             std::span<Vector> after);

  static constexpr int kSteps = 4;

  /// Takes a piece's share of the whole's losses, by mass; the shares of all pieces add up to all of them.
  /// @param share  of the whole's mass   @param from_centre  metres, to the piece's centre of mass from the whole's
  void inherit(const LostMomenta& whole, double share, const Double& from_centre);

 private:
  using Axial = turning::Axial<kDimension>;
  static Axial no_spin() { return turning::cross(Double(Double::Zero()), Double(Double::Zero())); }

  void give_back(std::span<const Vector> positions, std::span<const float> masses,
                 std::span<Vector> velocities);

  Double momentum_ = Double::Zero();  // kg m/s
  Axial spin_ = no_spin();            // kg m^2/s, about the world's origin
  int steps_ = 0;
};

extern template class LostMomenta<2>;
extern template class LostMomenta<3>;

}  // namespace softcell::ppu
