// Puts results that show the mode of its arithmetic: truncation, denormals to zero.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static vec_float4 out[8];

int main(uint64_t, uint64_t argp, uint64_t) {
  out[0] = spu_add(spu_splats(1.0f), spu_splats(5.0e-8f));       // stays 1: below half a unit and truncated
  out[1] = spu_sub(spu_splats(1.0f), spu_splats(1.0e-18f));      // just below 1
  out[2] = spu_mul(spu_splats(1.0e-30f), spu_splats(1.0e-15f));  // too small: 0
  mfc_put(out, argp, sizeof out, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  out[3] = spu_sub(spu_splats(1.0f), spu_splats(1.0e-18f));  // the same after calls out of the kernel
  mfc_put(out, argp, sizeof out, 0, 0, 0);
  mfc_read_tag_status_all();
  return 0;
}
