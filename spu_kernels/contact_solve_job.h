#pragma once
// The contract of the kernel `contact_solve`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.

#include <stdint.h>

namespace softcell::spu {

/// A particle: its velocity times the root of its mass. With that, one weight says both how
/// much a particle counts for a contact and how much of an impulse it gets.
struct alignas(16) SolveVelocity {
  float x, y, z;  ///< sqrt(kg) m/s
  float root;     ///< sqrt(kg) in SolveTask::start_ea, else 0
};
static_assert(sizeof(SolveVelocity) == 16, "a quadword");

/// The changes of a body's velocities in this step: `count` particles, and one slot of zeros. After them
/// as much again for pushes: velocities that last only for this step. Changes are small, so the truncation errors of their sums are small,
/// too: momentum is kept better than if impulses were added to velocities.
constexpr uint32_t solve_slots(uint32_t count) { return 2 * (count + 1); }

/// The particles of a soft body on which a contact acts, up to eight. Unused ones are the slot of
/// zeros, with a weight of zero; no other particle occurs twice.
struct alignas(16) SolveAnchor {
  uint16_t particle[8];
  float weight[8];  ///< share of the contact times the root of the inverse mass, 1/sqrt(kg)
};

/// A rigid body that impulses move.
struct alignas(16) SolveRigid {
  float velocity[3];  ///< changed: m/s, the change of its centre's velocity in this step
  float inverse_mass;
  float spin[3];                ///< changed: rad/s, likewise
  float held;                   ///< 0: the body is free, and members after inverse_inertia are not read
  float inverse_inertia[3][4];  ///< columns in world axes, 1/(kg m^2); the fourth row is 0
  // The supports of the body take a part of its impulses. Columns in world axes, as above.
  float linear[3][4];    ///< 1/kg: of its velocity by an impulse, besides that by the inverse mass
  float coupling[3][4];  ///< 1/(kg m): of its velocity by a moment
  float coupled[3][4];   ///< the transposed: of its spin by an impulse
};
static_assert(sizeof(SolveRigid) == 224, "fourteen quadwords");

/// The point of a rigid body on which a contact acts.
struct alignas(16) SolveRigidPoint {
  uint16_t rigid;  ///< index of the rigid body in the task
  uint16_t zeros[7];
  float arm[3];     ///< metres, from its centre of mass
  float push_mass;  ///< kg: of a alone, because nothing pushes rigid bodies
  /// 1/kg: the change of a's velocity against b's by an impulse of 1 kg m/s along the normal.
  float feels[3];
  float friction_mass;  ///< kg: the smallest mass against any impulse across the normal
};
static_assert(sizeof(SolveRigidPoint) == sizeof(SolveAnchor), "in place of each other");

/// A contact of a and b, where b may be something that nothing moves.
struct alignas(16) SolveContact {
  SolveAnchor a;
  union {
    SolveAnchor b;          ///< of a soft body
    SolveRigidPoint rigid;  ///< where the task has rigid bodies
  };                        ///< unused where it has neither
  float normal[3];          ///< from b to a, unit length
  float zero;
  /// m/s: the velocity of b minus that of a before anything has changed; b is a body, or what nothing moves.
  float carried[3];
  float least_velocity;  ///< m/s along the normal, of a against b
  float mass;            ///< kg: the mass that an impulse of 1 kg m/s moves by 1 m/s
  float friction;
  float push_velocity;        ///< m/s along the normal, out of each other; 0: none
  float push;                 ///< changed: kg m/s
  float friction_impulse[3];  ///< changed: kg m/s
  float impulse;              ///< changed: kg m/s along the normal, not negative
  float point[3];             ///< metres, in the world: for reports of contacts
  uint16_t cell_a, cell_b;    ///< the cells of the two anchors; kSolveNoCell: none
};
static_assert(sizeof(SolveContact) == 176, "eleven quadwords");

constexpr uint16_t kSolveNoCell = 0xFFFF;

/// The particles of a cell, corner k = bx + 2 by + 4 bz.
struct alignas(16) SolveCell {
  uint16_t particle[8];
};

/// Contacts of one body with another one, with itself, with rigid bodies, or with things that nothing moves. The kernel solves them one
/// after the other and then stiffens cells of the first body. Counts are at most kSolveMaxParticles, kSolveMaxContacts, kSolveMaxRigids,
/// kSolveMaxCells.
struct alignas(128) SolveTask {
  uint64_t a_ea;          ///< solve_slots(a_count) SolveVelocity, a multiple of 128
  uint64_t b_ea;          ///< likewise; 0: there is no b; a_ea: a body with itself
  uint64_t contacts_ea;   ///< contact_count SolveContact, a multiple of 16
  uint64_t cells_ea;      ///< cell_count SolveCell, a multiple of 16
  uint64_t positions_ea;  ///< if there are cells: of a's particles, x y z and anything, metres
  uint64_t start_ea;      ///< likewise: a_count SolveVelocity, before anything has changed
  uint64_t rigids_ea;     ///< rigid_count SolveRigid, a multiple of 16
  uint32_t a_count, b_count;
  uint32_t contact_count;
  uint32_t rigid_count;  ///< not 0: contacts are with these, and there is no b
  uint32_t cell_count;
  uint32_t iterations;    ///< over the contacts
  uint32_t pushes;        ///< 0: none of the contacts pushes
  uint32_t b_sleeps;      ///< not 0: nothing moves b, which is only read
  uint32_t a_sleeps;      ///< the same of a
  float stiffening;       ///< 0..1: the share of the relative motion of a cell's corners that is removed
  float inverse_spacing;  ///< 1/m
  uint32_t pad[7];
};
static_assert(sizeof(SolveTask) == 128, "one line");

constexpr uint32_t kSolveMaxParticles = 1023;
constexpr uint32_t kSolveMaxContacts = 512;
constexpr uint32_t kSolveMaxRigids = 64;
constexpr uint32_t kSolveMaxCells = 1024;

/// The job's descriptor, one line in main memory. Two jobs that run at the same time must not share a rigid body, or a soft body that
/// is awake in one of them.
struct alignas(128) SolveJob {
  uint64_t tasks_ea;    ///< task_count SolveTask, done in this order
  uint32_t task_count;  ///< any number, 0 included
  uint32_t pad[29];
};
static_assert(sizeof(SolveJob) == 128, "one line");

/// What the kernel's main returns.
enum SolveStatus : uint32_t { kSolveDone = 0, kSolveTooLarge = 1 };

}  // namespace softcell::spu
