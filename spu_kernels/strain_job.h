#pragma once
// The contract of the kernel `strain`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.

#include <stdint.h>

namespace softcell::spu {

/// Four distances between particles, along edges or diagonals of cells. The last group is filled up with copies of the last distance.
struct alignas(16) StrainLengths {
  uint16_t from[4], to[4];  ///< particles
  float inverse_square[4];  ///< of the distance at rest, 1 / m^2
};
static_assert(sizeof(StrainLengths) == 32, "two quadwords");

/// Four faces, each between two cells, `low` and `high` along an axis. Corner k = i + 2 j of a face, with i and j along the two other axes;
/// in two dimensions corners k and k + 2 are the same particle. The last group is filled up with faces that have particle 0 in all corners.
struct alignas(16) StrainFaces {
  uint16_t low[4][4];      ///< of each face: particles that only its low cell has
  uint16_t between[4][4];  ///< particles that both cells have
  uint16_t high[4][4];     ///< particles that only its high cell has
  float strength[4];       ///< 0 or more: the limits of the job are multiplied by it
};
static_assert(sizeof(StrainFaces) == 112, "seven quadwords");

struct alignas(16) StrainResult {
  float edges, diagonals;  ///< the largest change of a squared distance, over its value at rest: 0 or more
  uint32_t faces;          ///< the number of faces that may break
  uint32_t pad;
};
static_assert(sizeof(StrainResult) == 16, "one quadword");

/// The job's descriptor, one line in main memory: one body.
struct alignas(128) StrainJob {
  /// Of each particle: x y z 0, or x y in two dimensions; metres, finite; padded to groups of four particles.
  uint64_t positions_ea;
  uint64_t lengths_ea;       ///< edge_groups StrainLengths, then diagonal_groups
  uint64_t faces_ea;         ///< face_groups StrainFaces
  uint64_t result_ea;        ///< room for a StrainResult
  uint32_t particles;        ///< at most kStrainMaxParticles
  uint32_t flat;             ///< not 0: two dimensions
  uint32_t edge_groups;      ///< any number, 0 included
  uint32_t diagonal_groups;  ///< any number, 0 included
  uint32_t face_groups;      ///< any number, 0 included
  float spacing;             ///< of cells, metres
  float stretch;             ///< relative: a face of strength 1 breaks at it; kStrainNever: at none
  float turn;                ///< radians, the same
  uint32_t pad[16];
};
static_assert(sizeof(StrainJob) == 128, "one line");
constexpr float kStrainNever = 0x1p40f;

constexpr uint32_t kStrainMaxParticles = 10240;

/// The kernel reports faces that are somewhat below their limits: by this share of the limit, and for turns also by this many spacings in
/// the sum of a cell's edges. That is more than rounding errors in cells that are stretched to less than a hundred spacings.
constexpr float kStrainShare = 0x1p-10f, kStrainSpacings = 0x1p-14f;

/// What the kernel's main returns.
enum StrainStatus : uint32_t { kStrainDone = 0, kStrainTooLarge = 1 };

}  // namespace softcell::spu
