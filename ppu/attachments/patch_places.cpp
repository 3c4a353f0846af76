#include "ppu/attachments/patch_places.h"

#include <stdexcept>
#include <string>

#include "ppu/attachments/patch_spread.h"
#include "softcell/base/text.h"

namespace softcell::ppu {

template <int kDimension>
auto PatchPlaces<kDimension>::of(const Place& place, std::span<const Vector> values) const -> Vector {
  if (place.count == 1) return values[particle[place.first]];
  Vector sum = Vector::Zero();
  for (std::uint32_t i = place.first; i < place.first + place.count; ++i)
    sum += share[i] * values[particle[i]];
  return sum;
}

template <int kDimension>
void PatchPlaces<kDimension>::add(const Place& place, const AttachedBody<kDimension>& body,
                                  std::span<Vector> values, const Vector& impulse) const {
  for (std::uint32_t i = place.first; i < place.first + place.count; ++i)
    values[particle[i]] += share[i] * body.inverse_masses[particle[i]] * impulse;
}

template <int kDimension>
float PatchPlaces<kDimension>::mobility(const Place& place, std::span<const float> inverse_masses) const {
  float sum = 0;
  for (std::uint32_t i = place.first; i < place.first + place.count; ++i)
    sum += share[i] * share[i] * inverse_masses[particle[i]];
  return sum;
}

template <int kDimension>
auto PatchPlaces<kDimension>::append(std::uint32_t its_particle, float its_share) -> Place {
  particle.push_back(its_particle);
  share.push_back(its_share);
  return {static_cast<std::uint32_t>(particle.size() - 1), 1};
}

template <int kDimension>
auto PatchPlaces<kDimension>::append(const PatchParticles<kDimension>& patch, const Vector& point) -> Place {
  const Spread<kDimension> spread = spread_of(patch);
  constexpr float kFarthest = 12;
  const Vector in_patches = spread.inverse_of_root * (point - spread.middle);
  const float reaches = in_patches.norm();
  if (reaches > kFarthest)
    throw std::invalid_argument("a patch is held at a place " + base::shortest(reaches) +
                                " times as far from its middle as the patch reaches; it may be " +
                                base::shortest(kFarthest) +
                                " times as far: a larger patch can be held there");
  // S^-1 (p - c)
  const Vector pull = spread.inverse_of_root.transpose() * in_patches;
  const Place place{static_cast<std::uint32_t>(particle.size()),
                    static_cast<std::uint32_t>(patch.particles.size())};
  for (std::size_t i = 0; i < patch.particles.size(); ++i)
    append(patch.particles[i],
           patch.masses[i] / spread.mass * (1 + pull.dot(Vector(patch.positions[i] - spread.middle))));
  return place;
}

template <int kDimension>
auto PatchPlaces<kDimension>::append_middle(const PatchParticles<kDimension>& patch) -> Place {
  const Place place{static_cast<std::uint32_t>(particle.size()),
                    static_cast<std::uint32_t>(patch.particles.size())};
  float mass = 0;
  for (const float m : patch.masses) mass += m;
  for (std::size_t i = 0; i < patch.particles.size(); ++i) append(patch.particles[i], patch.masses[i] / mass);
  return place;
}

template <int kDimension>
void PatchPlaces<kDimension>::forget_pushes() {
  pushed.assign(particle.size(), Vector::Zero());
}

template <int kDimension>
void PatchPlaces<kDimension>::push(const Place& place, const AttachedBody<kDimension>& body,
                                   const Vector& impulse) {
  for (std::uint32_t i = place.first; i < place.first + place.count; ++i) {
    const Vector change = share[i] * body.inverse_masses[particle[i]] * impulse;
    body.pushes[particle[i]] += change;
    pushed[number_of(place, i)] += change;
  }
}

template struct PatchPlaces<2>;
template struct PatchPlaces<3>;

}  // namespace softcell::ppu
