// Puts results that show the mode of its arithmetic: truncation, denormals to zero; then again, computed
// after calls out of the kernel.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static vec_float4 out[8];

// Volatile: the compiler is not to know the results.
static volatile float one = 1.0f, tiny = 1.0e-18f, small = 1.0e-30f, smaller = 1.0e-10f, denormal = 1.0e-40f,
                      large = 1.0e10f;

static void compute(vec_float4* to) {
  to[0] = spu_sub(spu_splats(float{one}), spu_splats(float{tiny}));        // truncated: just below 1
  to[1] = spu_sub(spu_splats(float{tiny}), spu_splats(float{one}));        // and just above -1
  to[2] = spu_mul(spu_splats(float{small}), spu_splats(float{smaller}));   // a denormal result: 0
  to[3] = spu_mul(spu_splats(float{denormal}), spu_splats(float{large}));  // a denormal operand: 0
}

int main(uint64_t, uint64_t argp, uint64_t) {
  compute(out);
  mfc_put(out, argp, 4 * sizeof out[0], 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  compute(out + 4);
  mfc_put(out, argp, sizeof out, 0, 0, 0);
  mfc_read_tag_status_all();
  return 0;
}
