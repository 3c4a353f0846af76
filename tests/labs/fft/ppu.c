#include <math.h>
#include "../spes.h"
#include "fft.h"

extern spe_program_handle_t fft_spu;
static float re[POINTS] __attribute__((aligned(128))), im[POINTS] __attribute__((aligned(128)));

int main(void) {
  float x[POINTS];
  spe_t spe;
  int i, k, wrong = 0;
  for (i = 0; i < POINTS; i++) x[i] = re[i] = (float)((i * 37) % 64) / 32.0f - 1.0f;
  start_spe(&spe, &fft_spu, re, im);
  wrong += wait_spe(&spe) != 0;
  for (k = 0; k < POINTS; k++) {
    double r = 0, j = 0;
    for (i = 0; i < POINTS; i++) {
      r += x[i] * cos(2 * M_PI * i * k / POINTS);
      j -= x[i] * sin(2 * M_PI * i * k / POINTS);
    }
    if (fabs(r - re[k]) > 1e-3 || fabs(j - im[k]) > 1e-3) wrong++;
  }
  printf(wrong == 0 ? "ok\n" : "%d wrong\n", wrong);
  return wrong != 0;
}
