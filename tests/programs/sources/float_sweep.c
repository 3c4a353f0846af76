/* Computes a function of math.h for floats whose bits lie evenly apart: `argp` has the work. It is built for the host and for the SPU. */
#include <math.h>
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <stdint.h>

#include "float_functions.h"

struct sweep {
  uint32_t function, count; /* of results, a multiple of 1024 */
  uint32_t first, stride;   /* of the arguments' bits */
  uint64_t results;
  uint64_t reserved[13];
};
static struct sweep sweep __attribute__((aligned(128)));
static float result[1024] __attribute__((aligned(128)));

#define ENTRY(name) name##f,
static float (*const functions[])(float) = {FLOAT_FUNCTIONS(ENTRY)};

static void wait_for_all(void) {
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
}

int main(uint64_t id, uint64_t argp) {
  uint32_t done, i, bits;
  (void)id;
  mfc_get(&sweep, argp, sizeof sweep, 0, 0, 0);
  wait_for_all();
  bits = sweep.first;
  for (done = 0; done < sweep.count; done += 1024) {
    for (i = 0; i < 1024; ++i, bits += sweep.stride) {
      union {
        uint32_t bits;
        float x;
      } argument;
      argument.bits = bits;
      result[i] = functions[sweep.function](argument.x);
    }
    mfc_put(result, sweep.results + done * sizeof(float), sizeof result, 0, 0, 0);
    wait_for_all();
  }
  return 0;
}
