/* Computes one function of math.h for floats in main memory: `argp` has the number of the function, how many, and where they are. */
#include <math.h>
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <stdint.h>
#include <stdlib.h>

struct work {
  uint32_t function, count;
  uint64_t x, y, result;
  uint64_t reserved[12];
};
static struct work work __attribute__((aligned(128)));
static float x[1024] __attribute__((aligned(128))), y[1024] __attribute__((aligned(128))),
    result[1024] __attribute__((aligned(128)));

static float reciprocal_root(float v) { return 1.0f / sqrtf(v); }
static float (*const of_one[])(float) = {sqrtf,  expf,   logf,  sinf,  cosf,           tanf,
                                         atanf,  asinf,  acosf, tanhf, floorf,         ceilf,
                                         roundf, log10f, sinhf, cbrtf, reciprocal_root};
static float (*const of_two[])(float, float) = {powf, atan2f, fmodf, hypotf};

static void wait_for(unsigned int tag) {
  mfc_write_tag_mask(1 << tag);
  mfc_read_tag_status_all();
}

int main(uint64_t id, uint64_t argp) {
  mfc_get(&work, argp, sizeof work, 0, 0, 0);
  wait_for(0);
  for (uint32_t done = 0; done < work.count; done += 1024) {
    mfc_get(x, work.x + done * sizeof(float), sizeof x, 1, 0, 0);
    mfc_get(y, work.y + done * sizeof(float), sizeof y, 1, 0, 0);
    wait_for(1);
    for (int i = 0; i < 1024; ++i)
      result[i] = work.function < 100 ? of_one[work.function](x[i]) : of_two[work.function - 100](x[i], y[i]);
    mfc_put(result, work.result + done * sizeof(float), sizeof result, 1, 0, 0);
    wait_for(1);
  }
  exit(0);
}
