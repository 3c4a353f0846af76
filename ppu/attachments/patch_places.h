#pragma once
// Places of a soft body at which an attachment holds it, as shares of the particles of its patch.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/attachments/attached_body.h"

namespace softcell::ppu {

/// A range of the entries of PatchPlaces: one for each particle. Their shares sum to 1.
struct PatchPlace {
  std::uint32_t first = 0, count = 0;
};

/// All places of one side of an attachment. Places of several particles all have the same particles in the same order.
template <int kDimension>
struct PatchPlaces {
  using Vector = Eigen::Vector<float, kDimension>;
  using Place = PatchPlace;

  // Of each entry of each place:
  std::vector<std::uint32_t> particle;  ///< its number in the body
  std::vector<float> share;             ///< in the place
  /// m/s, of this substep: what push() gave each particle, by number_of().
  std::vector<Vector> pushed = {};

  /// The number of an entry's particle in the patch.
  static std::size_t number_of(const Place& place, std::uint32_t entry) {
    return place.count == 1 ? entry : entry - place.first;
  }
  /// The particles of the patch, each once. @param first  the first place
  std::span<const std::uint32_t> patch(const Place& first) const {
    const std::span<const std::uint32_t> all = particle;
    return first.count == 1 ? all : all.subspan(first.first, first.count);
  }

  /// Appends a particle as a place.
  Place append(std::uint32_t its_particle, float its_share);
  /// Appends the place `point` (metres, world), which moves with the mean deformation of the patch.
  /// @throws std::invalid_argument  the patch is too flat, or too small for a place as far away as that.
  Place append(const PatchParticles<kDimension>& patch, const Vector& point);
  /// Appends the middle of the patch.
  Place append_middle(const PatchParticles<kDimension>& patch);

  /// The value of a place. @param values  of all particles of the body
  Vector of(const Place& place, std::span<const Vector> values) const;
  /// Adds what an impulse (kg m/s) at the place changes. @param values  the velocities of the body's particles
  void add(const Place& place, const AttachedBody<kDimension>& body, std::span<Vector> values,
           const Vector& impulse) const;
  /// 1/kg: how far an impulse at the place changes the place's own velocity.
  float mobility(const Place& place, std::span<const float> inverse_masses) const;
  void forget_pushes();
  /// As add(), for the body's pushes, and keeps count of them in `pushed`.
  void push(const Place& place, const AttachedBody<kDimension>& body, const Vector& impulse);
};

extern template struct PatchPlaces<2>;
extern template struct PatchPlaces<3>;

}  // namespace softcell::ppu
