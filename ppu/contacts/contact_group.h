#pragma once
// Contacts that are solved together: those of one soft body with rigid ones, of two soft bodies, or of one with itself.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>

#include "contact_solve_job.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/obstacles/obstacle.h"

namespace softcell::ppu {

/// A contact: a body, called a, must not enter something, called b.
struct SoftContact {
  static constexpr float kNoLimit = std::numeric_limits<float>::infinity();

  Anchor a;
  Anchor b;                        ///< if b is a soft body
  std::uint32_t rigid = 0;         ///< index of b if it is rigid
  Eigen::Vector3f point{0, 0, 0};  ///< metres, world, at the substep's end
  /// Metres, world: where impulses act on b if it is rigid. This is the point's place at the substep's beginning, as particles and rigid
  /// bodies are where they are then: so both get the same moment, and nothing depends on how fast both move together.
  Eigen::Vector3f acts_at{0, 0, 0};
  Eigen::Vector3f normal{0, 1, 0};  ///< from b to a
  float least_velocity = 0;         ///< m/s along the normal, of a against b
  float depth = 0;                  ///< metres of penetration, negative if they are apart
  /// Metres along the normal, above the surface of a rigid b: where `point` would be at the substep's end without contacts.
  float above = 0;
  float friction = 0;
  float restitution = 0;  ///< of b if it is rigid
  /// Metres that body a may move on as a whole before something sharp crushes its cells (sharp_contacts.h); kNoLimit: nothing sharp.
  float room = kNoLimit;
  /// At held particles of body a, which rigid bodies press on: they feel what holds them.
  bool on_held = false;
  bool holds_pushes = false;  ///< a body has pushes of its own; they must not lead into the other one
  /// m/s: how a moves along b by such pushes. Friction resists the whole motion.
  Eigen::Vector3f slide{0, 0, 0};

  // Results of the solver.
  float impulse = 0;  ///< kg m/s along the normal
  Eigen::Vector3f friction_impulse{0, 0, 0};
  float push = 0;  ///< like impulse, but of ContactBody::pushes

  // Constants of the solver.
  float normal_mobility = 1;  ///< 1/kg
  float push_mobility = 1;
};

/// The two sides of a group's contacts. With rigid bodies `b` is null.
struct ContactSides {
  ContactBody* a = nullptr;
  ContactBody* b = nullptr;
  std::span<ContactRigid> rigids = {};
};

/// Computes the constants. Call it before the first iteration.
void prepare(std::span<SoftContact> contacts, const ContactSides& sides);

/// Converts a contact for the kernel contact_solve: of two soft bodies, or with a rigid one that nothing moves.
/// @pre  numbers of particles and cells fit in 16 bits
spu::SolveContact as_kernels_solve_it(const SoftContact& contact, const ContactSides& sides,
                                      std::span<const ContactRigid> rigids, float step);

/// Completes the result of as_kernels_solve_it() for a group in which impulses move some of the rigid bodies.
/// @param number  of the contact's rigid body in the kernel's task
void meet_rigid(spu::SolveContact& solved, const SoftContact& contact, const ContactSides& sides,
                std::uint16_t number);

/// Moves the anchors of a contact that the kernel contact_find has found, and of which one body is flat, to the bodies' own cells
/// (ContactModel::held()). @pre nothing has solved it yet
void hold_by_own_cells(spu::SolveContact& contact, const ContactBody& a, const ContactBody& b);

/// Sets SoftContact::holds_pushes and `slide` for the pushes that bodies have now.
void hold_pushes(SoftContact& contact, const ContactBody& a, const ContactBody* b);
/// Does the same for a contact that the kernel contact_find has found.
void hold_pushes(spu::SolveContact& contact, const ContactBody& a, const ContactBody& b);

/// One iteration over all contacts, one after the other (sequential impulses: [Cat05]).
void iterate(std::span<SoftContact> contacts, const ContactSides& sides, float step);

}  // namespace softcell::ppu
