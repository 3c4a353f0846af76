#pragma once
// A soft body that is attached to something, and the part of it that is held.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace softcell::ppu {

/// A soft body in one substep.
template <int kDimension>
struct AttachedBody {
  using Vector = Eigen::Vector<float, kDimension>;
  std::span<const Vector> positions;      ///< at the substep's beginning
  std::span<Vector> velocities;           ///< changed by attachments
  std::span<Vector> pushes;               ///< m/s, for this substep only
  std::span<const float> inverse_masses;  ///< 1/kg; 0 of a body that sleeps
  float spacing = 0;                      ///< metres, of a cell
  bool asleep = false;                    ///< an attachment does not move it
};

/// The particles of a patch as they are when it is attached.
template <int kDimension>
struct PatchParticles {
  std::vector<std::uint32_t> particles;  ///< ascending
  std::vector<Eigen::Vector<float, kDimension>> positions;
  std::vector<float> masses;  ///< kg

  /// The centre of mass.
  Eigen::Vector<float, kDimension> middle() const {
    Eigen::Vector<float, kDimension> sum = Eigen::Vector<float, kDimension>::Zero();
    float mass = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      sum += masses[i] * positions[i];
      mass += masses[i];
    }
    return sum / mass;
  }
};

}  // namespace softcell::ppu
