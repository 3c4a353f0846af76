#include "../spes.h"
#include "sort.h"

extern spe_program_handle_t sort_spu;
static int numbers[SPES * BLOCK] __attribute__((aligned(128)));
static unsigned int counter[32] __attribute__((aligned(128)));

int main(void) {
  static control_t control __attribute__((aligned(128)));
  spe_t spes[SPES];
  unsigned int i, wrong = 0, seed = 42;
  long sum = 0;
  for (i = 0; i < SPES * BLOCK; i++) sum += numbers[i] = (int)((seed = seed * 1664525u + 1013904223u) >> 8) - 8000000;
  control.numbers = (unsigned long)numbers;
  control.counter = (unsigned long)counter;
  for (i = 0; i < SPES; i++) start_spe(&spes[i], &sort_spu, &control, (void *)(unsigned long)i);
  for (i = 0; i < SPES; i++) wrong += wait_spe(&spes[i]) != 0;
  for (i = 0; i < SPES * BLOCK; i++) {
    sum -= numbers[i];
    if (i > 0 && numbers[i - 1] > numbers[i]) wrong++;
  }
  printf(wrong == 0 && sum == 0 ? "ok\n" : "%u wrong, %ld\n", wrong, sum);
  return wrong != 0;
}
