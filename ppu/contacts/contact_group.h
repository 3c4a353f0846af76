#pragma once
// Contacts that are solved together: of one soft body with rigid ones, of two with each other, or of one with
// itself.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "contact_solve_job.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/surfaces/obstacle.h"

namespace softcell::ppu {

/// Something, called b, that a body, called a, must not enter.
struct SoftContact {
  static constexpr float kNoLimit = std::numeric_limits<float>::infinity();

  Anchor a;
  Anchor b;                         ///< of soft bodies
  std::uint32_t rigid = 0;          ///< of rigid ones: its index
  Eigen::Vector3f point{0, 0, 0};   ///< metres, world
  Eigen::Vector3f normal{0, 1, 0};  ///< from b to a
  float least_velocity = 0;         ///< m/s along the normal, of a against b
  float depth = 0;                  ///< metres in which they are already, or less than 0
  float friction = 0;
  /// Metres that body a may go on as a whole before something sharp crushes its cells (sharp_contacts.h); kNoLimit: it is not sharp.
  float room = kNoLimit;
  bool on_held = false;       ///< with a rigid body that moves: body a's particles there are held
  bool holds_pushes = false;  ///< a body has pushes of its own, which must not lead into the other one

  // What solving changes.
  float impulse = 0;  ///< kg m/s along the normal
  Eigen::Vector3f friction_impulse{0, 0, 0};
  float push = 0;  ///< as impulse, of ContactBody::pushes

  // And needs.
  float normal_mobility = 1;  ///< 1/kg
  float push_mobility = 1;
};

/// The two sides of a group's contacts. With rigid bodies `b` is null.
struct ContactSides {
  ContactBody* a = nullptr;
  ContactBody* b = nullptr;
  std::span<ContactRigid> rigids = {};
};

/// Before the first iteration.
void prepare(std::span<SoftContact> contacts, const ContactSides& sides);

/// A contact of two soft bodies, or with a rigid one that nothing moves, for the kernel contact_solve.
/// @pre  particles and cells have 16 bits
spu::SolveContact as_kernels_solve_it(const SoftContact& contact, const ContactSides& sides,
                                      std::span<const ContactRigid> rigids, float step);

/// Of a contact as_kernels_solve_it(): it is solved among others of which some are with rigid bodies that impulses move.
/// @param number  of the rigid body among those of the kernel's task
void meet_rigid(spu::SolveContact& solved, const SoftContact& contact, const ContactSides& sides,
                std::uint16_t number);

/// A contact of two bodies that the kernel contact_find has found, of which one is flat: it is held by cells of the bodies themselves from
/// now on (ContactModel::held()). @pre nothing has solved it yet
void hold_by_own_cells(spu::SolveContact& contact, const ContactBody& a, const ContactBody& b);

/// As SoftContact::holds_pushes, of a contact that the kernel contact_find has found.
void hold_pushes(spu::SolveContact& contact);

/// One iteration over all contacts, one after the other (sequential impulses: [Cat05]).
void iterate(std::span<SoftContact> contacts, const ContactSides& sides, float step);

}  // namespace softcell::ppu
