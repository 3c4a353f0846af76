#include <math.h>
#include "../spes.h"
#include "kmeans.h"

extern spe_program_handle_t kmeans_spu;
static float xs[POINTS] __attribute__((aligned(128))), ys[POINTS] __attribute__((aligned(128)));
static centres_t centres __attribute__((aligned(128)));
static part_t parts[4] __attribute__((aligned(128)));

int main(void) {
  static const float true_x[4] = {0, 10, 0, 10}, true_y[4] = {0, 0, 10, 10};
  static problem_t problem __attribute__((aligned(16)));
  spe_t spes[4];
  unsigned int i, c, round, wrong = 0, seed = 7;
  for (i = 0; i < POINTS; i++) {
    seed = seed * 1103515245u + 12345u;
    xs[i] = true_x[i % 4] + (float)(seed >> 16 & 255) / 128.0f - 1.0f;
    ys[i] = true_y[i % 4] + (float)(seed >> 24 & 255) / 128.0f - 1.0f;
  }
  for (c = 0; c < 4; c++) {
    centres.x[c] = 4.0f + (float)(c & 1);
    centres.y[c] = 4.0f + (float)(c >> 1);
  }
  problem.xs = (unsigned long)xs;
  problem.ys = (unsigned long)ys;
  problem.centres = (unsigned long)&centres;
  problem.parts = (unsigned long)parts;
  for (i = 0; i < 4; i++) start_spe(&spes[i], &kmeans_spu, &problem, (void *)(unsigned long)i);
  for (round = 0; round < 8; round++) {
    for (i = 0; i < 4; i++) spe_signal_write(spes[i].ctx, SPE_SIG_NOTIFY_REG_2, 1);
    for (i = 0; i < 4; i++) {
      unsigned int rank;
      spe_out_intr_mbox_read(spes[i].ctx, &rank, 1, SPE_MBOX_ALL_BLOCKING);
      if (rank != i) wrong++;
    }
    for (c = 0; c < 4; c++) {
      float x = 0, y = 0;
      unsigned int n = 0;
      for (i = 0; i < 4; i++) {
        x += parts[i].sum_x[c];
        y += parts[i].sum_y[c];
        n += parts[i].count[c];
      }
      if (n != 0) {
        centres.x[c] = x / (float)n;
        centres.y[c] = y / (float)n;
      }
    }
  }
  for (i = 0; i < 4; i++) spe_signal_write(spes[i].ctx, SPE_SIG_NOTIFY_REG_2, 2);
  for (i = 0; i < 4; i++) wrong += wait_spe(&spes[i]) != 0;
  for (c = 0; c < 4; c++)
    if (fabs(centres.x[c] - true_x[c]) > 0.3 || fabs(centres.y[c] - true_y[c]) > 0.3) wrong++;
  printf(wrong == 0 ? "ok\n" : "%u wrong\n", wrong);
  return wrong != 0;
}
