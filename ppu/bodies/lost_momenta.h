#pragma once
// What shape matching and damping take off a body's momenta, and its return.
//
// Both act within a body, so its momentum and angular momentum should stay. They nearly do: rotations of regions are found by iterations that
// end a little behind a body that turns, and SPUs truncate. What is lost in a step is about what one bit of a float is, always to
// the same side: in a thousand steps a body that only turns loses 1/2000 of its angular momentum.
//
//     step    1      2      3      4             5  ...
//     lost    +      +      +      +  -> given back as one rigid motion; what floats cannot hold of it stays on account

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "ppu/numbers/turning.h"

namespace softcell::ppu {

/// Of one body. Used by one thread; allocates nothing.
template <int kDimension>
class LostMomenta {
 public:
  using Vector = Eigen::Vector<float, kDimension>;
  using Double = Eigen::Vector<double, kDimension>;

  /// Of a body that was moved by its user, nothing is lost.
  void forget() { *this = {}; }

  /// Velocities that forces within the body have changed in a step; every kSteps-th call changes `after` once more.
  /// @param positions  metres   @param masses  kg   @param before, after  m/s; all of each particle
  void count(std::span<const Vector> positions, std::span<const float> masses, std::span<const Vector> before,
             std::span<Vector> after);

  static constexpr int kSteps = 4;

  /// Of a piece, the part that it has in what was lost of the whole, by mass: of all pieces together all.
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
