#include <math.h>
#include "../spes.h"
#include "nbody.h"

extern spe_program_handle_t nbody_spu;
static body_t bodies[BODIES] __attribute__((aligned(128)));
static vec_t forces[BODIES] __attribute__((aligned(128)));

int main(void) {
  static job_t jobs[4] __attribute__((aligned(16)));
  spe_t spes[4];
  unsigned int i, j, wrong = 0, seed = 1;
  for (i = 0; i < BODIES; i++) {
    float *f = &bodies[i].x;
    for (j = 0; j < 4; j++) f[j] = (float)((seed = seed * 1103515245u + 12345u) >> 16 & 1023) / 256.0f;
  }
  for (i = 0; i < 4; i++) {
    jobs[i].bodies = (unsigned long)bodies;
    jobs[i].forces = (unsigned long)forces;
    jobs[i].first = i * BODIES / 4;
    jobs[i].count = BODIES / 4;
    start_spe(&spes[i], &nbody_spu, &jobs[i], NULL);
  }
  for (i = 0; i < 4; i++) wrong += wait_spe(&spes[i]) != 0;
  for (i = 0; i < BODIES; i++) {
    double fx = 0, fy = 0, fz = 0, scale = 1e-3;
    for (j = 0; j < BODIES; j++) {
      double dx = bodies[j].x - bodies[i].x, dy = bodies[j].y - bodies[i].y, dz = bodies[j].z - bodies[i].z;
      double r2 = dx * dx + dy * dy + dz * dz + 0.01, w = bodies[j].mass / (r2 * sqrt(r2));
      fx += dx * w;
      fy += dy * w;
      fz += dz * w;
      scale += bodies[j].mass / r2;
    }
    if (fabs(fx - forces[i].x) > 1e-4 * scale || fabs(fy - forces[i].y) > 1e-4 * scale ||
        fabs(fz - forces[i].z) > 1e-4 * scale)
      wrong++;
  }
  printf(wrong == 0 ? "ok\n" : "%u wrong\n", wrong);
  return wrong != 0;
}
