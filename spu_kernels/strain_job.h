#pragma once
// The contract of the kernel `strain`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.

#include <stdint.h>

namespace softcell::spu {

/// Four distances between particles, along edges or diagonals of cells. A last group that is not full repeats its last one.
struct alignas(16) StrainLengths {
  uint16_t from[4], to[4];  ///< particles
  float inverse_square[4];  ///< of the distance at rest, 1 / m^2
};
static_assert(sizeof(StrainLengths) == 32, "two quadwords");

/// Four faces, each between two cells, `low` and `high` along some axis. Corner k = i + 2 j of a face by the two other axes; in
/// two dimensions corners k and k + 2 are one particle. Faces of a last group that are none have particle 0 in all their corners.
struct alignas(16) StrainFaces {
  uint16_t low[4][4];      ///< of each face: particles that only its low cell has
  uint16_t between[4][4];  ///< that both cells have
  uint16_t high[4][4];     ///< that only its high cell has
  float strength[4];       ///< by which a face bears more than the job says, 0 or more
};
static_assert(sizeof(StrainFaces) == 112, "seven quadwords");

struct alignas(16) StrainResult {
  float edges, diagonals;  ///< the largest change of a distance's square, over that at rest: 0 or more
  uint32_t faces;          ///< how many may break
  uint32_t pad;
};
static_assert(sizeof(StrainResult) == 16, "one quadword");

/// The job's descriptor, one line in main memory: one body.
struct alignas(128) StrainJob {
  uint64_t
      positions_ea;  ///< metres, finite, of each particle: x y z 0, or x y; padded to groups of four particles
  uint64_t lengths_ea;       ///< edge_groups and then diagonal_groups StrainLengths
  uint64_t faces_ea;         ///< face_groups StrainFaces
  uint64_t result_ea;        ///< room for a StrainResult
  uint32_t particles;        ///< at most kStrainMaxParticles
  uint32_t flat;             ///< not 0: two dimensions
  uint32_t edge_groups;      ///< any number, 0 included, as the next two
  uint32_t diagonal_groups;  ///< 0: nothing is asked of lengths
  uint32_t face_groups;      ///< 0: nothing is asked of faces
  float spacing;             ///< of cells, metres
  float stretch;             ///< a face of strength 1 breaks at this relative stretch; kStrainNever: by none
  float turn;                ///< likewise at this turn, radians
  uint32_t pad[16];
};
static_assert(sizeof(StrainJob) == 128, "one line");
constexpr float kStrainNever = 0x1p40f;

constexpr uint32_t kStrainMaxParticles = 10240;

/// By how much less than what breaks a face is reported: a share of it, and of turns that many spacings of cells in the sum of a cell's
/// edges besides. More than rounding can hide, in cells that are drawn out by less than a hundred of their spacings.
constexpr float kStrainShare = 0x1p-10f, kStrainSpacings = 0x1p-14f;

/// What the kernel's main returns.
enum StrainStatus : uint32_t { kStrainDone = 0, kStrainTooLarge = 1 };

}  // namespace softcell::spu
