#pragma once
// What a substep's contacts are told of a soft body.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/known_sides.h"
#include "softcell/soft_bodies/contact.h"

namespace softcell::ppu {

/// A soft body and the obstacles near it.
struct BodyInSubstep {
  const ContactModel* model = nullptr;
  std::span<const Eigen::Vector3f> positions = {};   ///< of its particles, metres
  std::span<const Eigen::Vector3f> velocities = {};  ///< m/s, with the gravity of the substep included
  float friction = 0.5f;
  float restitution = 0;
  Bounds<3> box = {};                         ///< box_of_step()
  std::vector<std::uint32_t> obstacles = {};  ///< indices of obstacles that it may meet
  KnownSides* sides = nullptr;                ///< what the body remembers from substep to substep; not null
  bool asleep = false;                        ///< contacts do not move it
  CollisionFilter filter = {};                ///< towards other soft bodies
  bool self_contacts = true;                  ///< SoftBodySettings::self_contacts
};

/// A box around particles and their places after `step` seconds. @pre there is at least one
Bounds<3> box_of_step(std::span<const Eigen::Vector3f> positions, std::span<const Eigen::Vector3f> velocities,
                      float step);

}  // namespace softcell::ppu
