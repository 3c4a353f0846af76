// rotations: the rotations nearest to given matrices, by the code that `match` uses for regions. For
// benchmarks.
//
//   array     direction  element                       count          alignment
//   job       in         RotationsJob, 128 bytes       1              128
//   matrices  in         RotationMatrices, 144 bytes   <= 256         16
//   starts    in         MatchRotations, 64 bytes      <= 256         16
//   found     out        MatchRotations, 64 bytes      as many        16
//
// Budget: 96 KB. 36 KB of matrices, 16 each of quaternions in and out, the rest for code and 4 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "rotation.h"
#include "rotations_job.h"

namespace softcell::spu {
namespace {

enum Tag : uint32_t { kTagIn = 0, kTagOut = 1 };

constexpr uint32_t kBlock = 8;  // groups whose iterations overlap, as in match

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  RotationsJob job;
  alignas(128) Matrix3x4 matrices[kRotationsMaxGroups];
  alignas(128) Quaternion4 starts[kRotationsMaxGroups];
  alignas(128) Quaternion4 found[kRotationsMaxGroups];
  RotationProblem problems[kBlock];
};
static_assert(sizeof(Matrix3x4) == sizeof(RotationMatrices) && sizeof(Quaternion4) == sizeof(MatchRotations),
              "the same bytes");
LocalStoreMap ls;

/// Finds the rotations of groups first to first + count - 1. @param count  at most kBlock
void find_block(uint32_t first, uint32_t count) {
  const vec_float4 zero = spu_splats(0.0f), one = spu_splats(1.0f);
  const RotationEffort effort = {ls.job.least_iterations, ls.job.most_iterations};
  Quaternion4* const q = ls.found + first;
  for (uint32_t g = 0; g < count; ++g) {
    ls.problems[g] = {normalised(ls.matrices[first + g], {one, zero}), {zero, zero, zero}};
    q[g] = ls.starts[first + g];
  }
  vec_uint4 indefinite[kBlock];
  improve_rotations(ls.problems, q, indefinite, count, effort);
  for (uint32_t g = 0; g < count; ++g)
    ls.problems[g].a = rotation_of(ls.problems[g], q[g], indefinite[g]).matrix;
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a RotationsJob. Returns a RotationsStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(RotationsJob), kTagIn, 0, 0);
  wait_for_tag(kTagIn);
  const uint32_t groups = ls.job.group_count;
  if (groups > kRotationsMaxGroups) return kRotationsTooMany;
  get_large(ls.matrices, ls.job.matrices_ea, groups * static_cast<uint32_t>(sizeof(RotationMatrices)),
            kTagIn);
  get_large(ls.starts, ls.job.starts_ea, groups * static_cast<uint32_t>(sizeof(MatchRotations)), kTagIn);
  wait_for_tag(kTagIn);
  for (uint32_t repeat = 0; repeat < ls.job.repeats; ++repeat) {
    for (uint32_t first = 0; first < groups; first += kBlock)
      find_block(first, groups - first < kBlock ? groups - first : kBlock);
  }
  put_large(ls.found, ls.job.found_ea, groups * static_cast<uint32_t>(sizeof(MatchRotations)), kTagOut);
  wait_for_tag(kTagOut);
  return kRotationsDone;
}
