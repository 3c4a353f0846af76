/* 64 contexts, each of which waits for all others: more than there are SPEs. */
#include "run_in_thread.h"

extern spe_program_handle_t meets_all;

#define CONTEXTS 64
#define ROUNDS 5

static unsigned int line[32] __attribute__((aligned(128)));

int main(void) {
  static spe_thread_t spes[CONTEXTS];
  int i;
  line[2] = CONTEXTS;
  for (i = 0; i < CONTEXTS; ++i) start_spe(&spes[i], &meets_all, 0, line, (void*)(uintptr_t)ROUNDS);
  for (i = 0; i < CONTEXTS; ++i) CHECK(end_spe(&spes[i]) == 0);
  CHECK(line[0] == 0 && line[1] == ROUNDS);
  puts("ok");
  return 0;
}
