#pragma once
// The values that a user sees of a particle of which a hand has taken hold and of its region, or of a contact.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// The particle at one moment. In two dimensions the last number of each vector is 0.
struct PickedParticle {
  std::uint32_t body = 0, particle = 0;
  Eigen::Vector3f position{0, 0, 0}, velocity{0, 0, 0};  ///< m, m/s
  float mass = 0;                                        ///< kg
  std::size_t region = 0;                                ///< particles in its region
  float region_mass = 0;                                 ///< kg, of all particles in its region
  Eigen::Vector3f region_velocity{0, 0, 0};              ///< m/s, of their centre of mass
};

/// A contact that the user has clicked, in three dimensions.
struct PickedContact {
  std::string first, second;  ///< what the two bodies are called
  Eigen::Vector3f position{0, 0, 0};
  Eigen::Vector3f normal{0, 1, 0};  ///< unit length, from the second body to the first
  /// kg m/s along the normal, in the last substep; 0: they do not press on each other now.
  float impulse = 0;
  float force = 0;  ///< N: the impulse divided by the substep
};

/// @pre  the body has the particle
template <int Dimension>
PickedParticle picked_particle(const ppu::SoftBody<Dimension>& body, std::uint32_t number,
                               std::uint32_t particle) {
  const ppu::SoftBodyModel<Dimension>& model = body.model();
  SC_ASSERT(particle < model.particles(), "particle {} of {} is picked", particle, model.particles());
  const auto padded = [](const auto& v) {
    Eigen::Vector3f result = Eigen::Vector3f::Zero();
    for (int axis = 0; axis < Dimension; ++axis) result[axis] = v[axis];
    return result;
  };
  // Like find_regions(), for one region.
  std::vector<std::uint32_t> region{particle};
  std::vector<bool> known(model.particles());
  known[particle] = true;
  std::size_t begin = 0;
  for (int link = 0; link < model.settings().half_width; ++link) {
    const std::size_t end = region.size();
    for (; begin < end; ++begin) {
      for (const std::uint32_t other : model.lattice().neighbours[region[begin]]) {
        if (!known[other]) region.push_back(other);
        known[other] = true;
      }
    }
  }
  PickedParticle picked{.body = number,
                        .particle = particle,
                        .position = padded(body.position(particle)),
                        .velocity = padded(body.velocities()[particle]),
                        .mass = model.masses()[particle],
                        .region = region.size()};
  for (const std::uint32_t member : region) {
    picked.region_mass += model.masses()[member];
    picked.region_velocity += model.masses()[member] * padded(body.velocities()[member]);
  }
  picked.region_velocity /= picked.region_mass;
  return picked;
}

}  // namespace softcell::demos
