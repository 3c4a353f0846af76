#include "run_in_thread.h"

extern spe_program_handle_t scales;

typedef struct {
  unsigned long long in, out;
  unsigned int blocks;
  float factor;
  unsigned int padding[2];
} job_t;

#define SPES 6
#define BLOCKS 9
#define FLOATS (BLOCKS * 1024)

static float in[SPES][FLOATS] __attribute__((aligned(128)));
static float out[SPES][FLOATS] __attribute__((aligned(128)));

int main(void) {
  spe_thread_t spes[SPES];
  static job_t jobs[SPES] __attribute__((aligned(128)));
  int i, k;
  for (i = 0; i < SPES; ++i) {
    for (k = 0; k < FLOATS; ++k) in[i][k] = (float)(k + i);
    jobs[i].in = (unsigned long long)(uintptr_t)in[i];
    jobs[i].out = (unsigned long long)(uintptr_t)out[i];
    jobs[i].blocks = BLOCKS;
    jobs[i].factor = (float)(1 << i);
    start_spe(&spes[i], &scales, 0, &jobs[i], NULL);
  }
  for (i = 0; i < SPES; ++i) {
    CHECK(end_spe(&spes[i]) == 0);
    for (k = 0; k < FLOATS; ++k) CHECK(out[i][k] == (float)(k + i) * (float)(1 << i));
  }
  puts("ok");
  return 0;
}
