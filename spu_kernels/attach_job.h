#pragma once
// The contract of the kernel `attach`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.

#include <stdint.h>

#include "contact_solve_job.h"

namespace softcell::spu {

/// Adjacent particles of a body, some of which are attached. The kernel numbers the particles of all runs, in the order of runs: these
/// numbers are slots. Velocities are as for contact_solve: changes in this step, times the root of the mass.
struct alignas(16) AttachRun {
  uint64_t velocities_ea;  ///< count SolveVelocity
  uint32_t pushes;         ///< bytes from there to the pushes of the same particles
  uint32_t count;
};
static_assert(sizeof(AttachRun) == 16, "a quadword");

/// A rigid body that impulses move.
struct alignas(16) AttachRigid {
  uint64_t rigid_ea;  ///< a SolveRigid with held = 0, a multiple of 16
  uint32_t pad[2];
};
static_assert(sizeof(AttachRigid) == 16, "a quadword");

/// The kinds of attachments. Each attachment has the next records of the job's arrays.
enum AttachKind : uint32_t {
  /// Holds each particle of a patch. Its records are points, which are solved at once, together with their rigid body.
  kAttachPoints = 0,
  /// Holds places that are weighted means of particles. Its records are up to four rows, which are solved at once. No rigid body moves.
  kAttachPlaces = 1,
  /// Holds places at a rigid body that moves. Its records are rows, which are solved one after the other.
  kAttachHinge = 2,
  kAttachRope = 3  ///< holds a place within a distance; its record is one row
};

/// An attachment. The square matrices, of up to four rows, are stored by columns.
struct alignas(16) AttachLink {
  uint32_t kind;        ///< AttachKind
  uint32_t points;      ///< number of points of kAttachPoints, else 0
  uint32_t rows;        ///< number of rows of the other kinds, 1 to 4
  uint32_t entries[2];  ///< number of entries of the other kinds: of the first body, then of the second
  uint32_t rigid;       ///< index of the rigid body in the job; kAttachNoRigid: there is none that moves
  uint32_t pushes;      ///< not 0: errors of position become pushes
  uint32_t breaks;      ///< not 0: the attachment breaks at most_impulse
  float softness;       ///< 1/kg: compliance over the square of the step; 0: the attachment is rigid
  float most_impulse;   ///< kg m/s
  float most_push[2];   ///< m/s, of a particle of each body
  /// For kAttachPoints with a rigid body, over the points and the body: the sum of mass times arm, the inverse of the sum of masses, and
  /// the inverse of the inertia about their common centre of mass.
  float arms[3], inverse_sum;
  float inverse_inertia[3][4];
  float inverse[4][4];  ///< kg, row i, column j: impulse at place i for each m/s of error at place j
  float inverse_of_pushes[4][4];
  uint32_t broke;  ///< changed: not 0 if the impulse was above most_impulse in the last iteration
  /// Not 0: no other link changes the bodies of this one, so the kernel solves it only in the first iteration.
  uint32_t once;
  uint32_t pad[2];
};
static_assert(sizeof(AttachLink) == 256, "sixteen quadwords");
constexpr uint32_t kAttachNoRigid = 0xFFFFFFFFu;

/// A particle that is held.
struct alignas(16) AttachPoint {
  float carried[3];  ///< m/s: the velocity that holds it, minus its own before anything has changed
  float mass;        ///< kg: the mass that an impulse of 1 kg m/s moves by 1 m/s, softness included
  float error[3];    ///< m/s: of position, over the step
  float push_mass;   ///< kg
  float arm[3];      ///< metres, from the rigid body's centre
  float weight;      ///< 1/sqrt(kg): the root of its inverse mass
  float impulse[3];  ///< changed: kg m/s
  uint32_t slot;
  float pushed[3];  ///< changed: sqrt(kg) m/s: the sum of this attachment's pushes of the particle
  float pad;
  float missing[4];  ///< only for the kernel
};
static_assert(sizeof(AttachPoint) == 96, "six quadwords");

/// A place that is held.
struct alignas(16) AttachRow {
  float carried[3];     ///< as of a point
  float most;           ///< m/s: limit of the velocity of a against b along the rope
  float error[3];       ///< as of a point
  float push_mass;      ///< kg
  float arm[3];         ///< as of a point
  float mass;           ///< kg, along the rope, softness included
  float impulse[3];     ///< changed: kg m/s
  float push;           ///< changed: kg m/s, of a rope
  float along[3];       ///< of a rope: unit length, from b to a
  float push_most;      ///< m/s, of a rope: 0 or less
  float inverse[3][4];  ///< kg, of a hinge: columns
};
static_assert(sizeof(AttachRow) == 128, "eight quadwords");

/// A particle from which places are computed.
struct alignas(16) AttachEntry {
  float weight[4];  ///< 1/sqrt(kg): its share of each row's place times the root of its inverse mass
  float pushed[3];  ///< changed: as of a point
  float root;       ///< 1/sqrt(kg): the root of its inverse mass
  uint32_t slot;
  uint32_t pad[3];
};
static_assert(sizeof(AttachEntry) == 48, "three quadwords");

/// The job's descriptor, one line in main memory: attachments, which the kernel solves in their order, up to `iterations` times. They may
/// be independent of each other. Two jobs that run at the same time must not share a rigid body, or a soft body that is awake.
struct alignas(128) AttachJob {
  uint64_t runs_ea;     ///< run_count AttachRun; all these addresses are multiples of 16
  uint64_t links_ea;    ///< link_count AttachLink
  uint64_t points_ea;   ///< point_count AttachPoint
  uint64_t rows_ea;     ///< row_count AttachRow
  uint64_t entries_ea;  ///< entry_count AttachEntry
  uint64_t rigids_ea;   ///< rigid_count AttachRigid
  uint32_t run_count, link_count, point_count, row_count, entry_count;
  uint32_t rigid_count;
  uint32_t iterations;  ///< the most iterations over all links
  uint32_t pushes;      ///< 0: no link pushes, and pushes are not fetched
  uint32_t ends;  ///< not 0: this is the last job of a step; it limits pushes to the most_push of their links
  uint32_t pad[11];
};
static_assert(sizeof(AttachJob) == 128, "one line");

constexpr uint32_t kAttachMaxSlots = 2048;  ///< of all runs
constexpr uint32_t kAttachMaxRuns = 256;
constexpr uint32_t kAttachMaxLinks = 48;
constexpr uint32_t kAttachMaxPoints = 384;
constexpr uint32_t kAttachMaxRows = 96;
constexpr uint32_t kAttachMaxEntries = 1280;
constexpr uint32_t kAttachMaxRigids = 48;

/// What the kernel's main returns.
enum AttachStatus : uint32_t { kAttachDone = 0, kAttachTooLarge = 1 };

}  // namespace softcell::spu
