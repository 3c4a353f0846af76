#pragma once
// The contract of the kernel `contact_solve`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.

#include <stdint.h>

namespace softcell::spu {

/// What the kernel has of a particle: a velocity times the root of its mass, so that one number says both how
/// much a particle counts for a contact and how much it takes of an impulse.
struct alignas(16) SolveVelocity {
  float x, y, z;  ///< sqrt(kg) m/s
  float root;     ///< sqrt(kg) in SolveTask::start_ea, else 0
};
static_assert(sizeof(SolveVelocity) == 16, "a quadword");

/// How a body's velocities have changed in this step: of its `count` particles, and one slot of zeros. Behind them
/// as much again for pushes: velocities that last one step only. Changes are small, so the sums that truncate are
/// too: momentum is kept better than by adding to velocities themselves.
constexpr uint32_t solve_slots(uint32_t count) { return 2 * (count + 1); }

/// Where a contact holds on to a soft body: up to eight particles. Those that are not needed are the slot of
/// zeros with a weight of zero; no other one occurs twice.
struct alignas(16) SolveAnchor {
  uint16_t particle[8];
  float weight[8];  ///< share of the contact times the root of the inverse mass, 1/sqrt(kg)
};

/// A rigid body that impulses move.
struct alignas(16) SolveRigid {
  float velocity[3];  ///< changed: m/s, how that of its centre has changed in this step
  float inverse_mass;
  float spin[3];                ///< changed: rad/s, likewise
  float held;                   ///< 0: it is free, and what follows the inverse inertia is not read
  float inverse_inertia[3][4];  ///< columns in world axes, 1/(kg m^2); the fourth row is 0
  // What it lies on takes a part of impulses. Columns in world axes, as above.
  float linear[3][4];    ///< 1/kg: of its velocity by an impulse, besides that by the inverse mass
  float coupling[3][4];  ///< 1/(kg m): of its velocity by a moment
  float coupled[3][4];   ///< the transposed: of its spin by an impulse
};
static_assert(sizeof(SolveRigid) == 224, "fourteen quadwords");

/// Where a contact holds on to a rigid body.
struct alignas(16) SolveRigidPoint {
  uint16_t rigid;  ///< which of the task's
  uint16_t zeros[7];
  float arm[3];     ///< metres, from its centre of mass
  float push_mass;  ///< kg: of a alone; nothing pushes rigid bodies
  float feels[3];  ///< 1/kg: what an impulse of 1 kg m/s along the normal changes of a's velocity against b's
  float friction_mass;  ///< kg: the least that an impulse across the normal may meet
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
  float mass;            ///< kg: what an impulse of 1 kg m/s moves by 1 m/s
  float friction;
  float push_velocity;        ///< m/s along the normal, out of each other; 0: none
  float push;                 ///< changed: kg m/s
  float friction_impulse[3];  ///< changed: kg m/s
  float impulse;              ///< changed: kg m/s along the normal, not negative
  float point[3];             ///< metres, world: for those who ask where bodies touch
  uint16_t cell_a, cell_b;    ///< that hold the two anchors; kSolveNoCell: none does
};
static_assert(sizeof(SolveContact) == 176, "eleven quadwords");

constexpr uint16_t kSolveNoCell = 0xFFFF;

/// The particles of a cell, corner k = bx + 2 by + 4 bz.
struct alignas(16) SolveCell {
  uint16_t particle[8];
};

/// Contacts of one body with another one, with itself, with rigid bodies, or with what nothing moves, one after the other; then
/// cells of the first body are stiffened. Counts within kSolveMaxParticles, kSolveMaxContacts, kSolveMaxRigids, kSolveMaxCells.
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
  uint32_t iterations;  ///< over the contacts
  uint32_t pushes;      ///< 0: none of the contacts pushes
  uint32_t b_sleeps;    ///< not 0: b is only read, because nothing moves it; likewise a
  uint32_t a_sleeps;
  float stiffening;       ///< 0..1: the share that is taken of what corners of a cell do against each other
  float inverse_spacing;  ///< 1/m
  uint32_t pad[7];
};
static_assert(sizeof(SolveTask) == 128, "one line");

constexpr uint32_t kSolveMaxParticles = 1023;
constexpr uint32_t kSolveMaxContacts = 512;
constexpr uint32_t kSolveMaxRigids = 64;
constexpr uint32_t kSolveMaxCells = 1024;

/// The job's descriptor, one line in main memory. No two jobs that run at the same time may share a rigid body, or a soft one that
/// is not asleep in both.
struct alignas(128) SolveJob {
  uint64_t tasks_ea;    ///< task_count SolveTask, done in this order
  uint32_t task_count;  ///< any number, 0 included
  uint32_t pad[29];
};
static_assert(sizeof(SolveJob) == 128, "one line");

/// What the kernel's main returns.
enum SolveStatus : uint32_t { kSolveDone = 0, kSolveTooLarge = 1 };

}  // namespace softcell::spu
