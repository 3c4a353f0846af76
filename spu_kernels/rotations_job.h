#pragma once
// The contract of the kernel `rotations`, a part of `match` for benchmarks: it computes the rotations nearest
// to matrices in main memory. Freestanding; included by the kernel and by the PPU side.

#include <stdint.h>

#include "match_job.h"

namespace softcell::spu {

/// Four 3x3 matrices by rows, an element of each in one quadword.
struct alignas(16) RotationMatrices {
  float element[9][4];
};
static_assert(sizeof(RotationMatrices) == 144, "nine quadwords");

/// Most groups of four in one job: the kernel holds them all in local store.
constexpr uint32_t kRotationsMaxGroups = 256;

/// The job's descriptor, one line in main memory.
struct alignas(128) RotationsJob {
  /// group_count RotationMatrices with finite elements, a multiple of 16 (128 is fastest).
  uint64_t matrices_ea;
  uint64_t starts_ea;    ///< group_count MatchRotations, likewise aligned; unit quaternions of the last step
  uint64_t found_ea;     ///< room for as many, likewise aligned
  uint32_t group_count;  ///< 0..kRotationsMaxGroups
  uint32_t repeats;      ///< how often the kernel does the same work from the beginning
  uint32_t least_iterations;  ///< as in MatchJob
  uint32_t most_iterations;
  uint32_t pad[22];
};
static_assert(sizeof(RotationsJob) == 128, "one line");

/// What the kernel's main returns.
enum RotationsStatus : uint32_t { kRotationsDone = 0, kRotationsTooMany = 1 };

}  // namespace softcell::spu
