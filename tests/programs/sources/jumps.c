/* Jumps, functions of four floats at once, and the clock. */
#include <inttypes.h>
#include <profile.h>
#include <setjmp.h>
#include <simdmath.h>
#include <spu_intrinsics.h>
#include <spu_timer.h>

#include "check.h"

static jmp_buf out;
static int depth;

static void dive(int levels) {
  if (levels < 0) return;
  if (levels == 0) longjmp(out, 7);
  ++depth;
  dive(levels - 1);
  CHECK(0);
}

static int near(float a, double b) { return a > b * (1 - 3e-7) - 1e-30 && a < b * (1 + 3e-7) + 1e-30; }

int main(void) {
  const vec_float4 v = {1.0f, 4.0f, 9.0f, 0.25f};
  const int value = setjmp(out);
  if (value == 0) dive(5);
  CHECK(value == 7 && depth == 5);
  CHECK(near(spu_extract(sqrtf4(v), 2), 3.0) && near(spu_extract(recipf4(v), 1), 0.25) &&
        near(spu_extract(rsqrtf4(v), 3), 2.0));
  CHECK(near(spu_extract(divf4(v, spu_splats(3.0f)), 1), 4.0 / 3) &&
        spu_extract(fabsf4(negatef4(v)), 0) == 1.0f);
  CHECK(spu_extract(fminf4(v, spu_splats(2.0f)), 1) == 2.0f &&
        spu_extract(fmaxf4(v, spu_splats(2.0f)), 2) == 9.0f);
  CHECK(near(spu_extract(powf4(v, spu_splats(0.5f)), 2), 3.0) &&
        near(spu_extract(cosf4(v), 0), 0.5403023058681398));
  CHECK(spu_extract(absi4(spu_splats(-3)), 1) == 3);
  CHECK(spu_clock_read() == 0 && spu_clock_stop() == -1 && spu_clock_start() == 0);
  const uint64_t before = spu_clock_read();
  prof_cp1();
  CHECK(spu_clock_read() >= before && spu_clock_stop() == 0);
  return failures;
}
