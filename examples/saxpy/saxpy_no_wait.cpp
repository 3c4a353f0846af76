// saxpy with the classic mistake: it computes before its data have arrived. On a console this works most of
// the time. softcell runs it with `--dma lazy` to show wrong numbers, and with --checked to name the line.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "saxpy_job.h"

namespace {

constexpr uint32_t kMostFloats = 4096;

alignas(128) vec_float4 x[kMostFloats / 4];
alignas(128) vec_float4 y[kMostFloats / 4];
alignas(16) SaxpyJob job;

void wait(uint32_t tag) {
  mfc_write_tag_mask(1u << tag);
  mfc_read_tag_status_all();
}

}  // namespace

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(&job, argp, sizeof job, 0, 0, 0);
  wait(0);
  if (job.count % 4 != 0) return kSaxpyCountNotMultipleOf4;
  if (job.count > kMostFloats) return kSaxpyTooMany;

  const uint32_t count = static_cast<uint32_t>(job.count);
  const vec_float4 a = (vec_float4)spu_splats(static_cast<uint32_t>(job.a));
  mfc_get(x, job.x, count * sizeof(float), 1, 0, 0);
  mfc_get(y, job.y, count * sizeof(float), 1, 0, 0);
  // Here wait(1) is missing.
  for (uint32_t i = 0; i < count / 4; ++i) y[i] = spu_madd(a, x[i], y[i]);  // too early
  mfc_put(y, job.y, count * sizeof(float), 1, 0, 0);
  wait(1);
  return kSaxpyDone;
}
