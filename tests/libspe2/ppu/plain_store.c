/* An SPE sleeps until a thread of the PPU stores to the line that it has reserved. */
#include <unistd.h>

#include "run_in_thread.h"

extern spe_program_handle_t waits_for_memory;

static volatile unsigned int line[32] __attribute__((aligned(128)));

int main(void) {
  spe_thread_t spe;
  start_spe(&spe, &waits_for_memory, 0, (void*)line, NULL);
  usleep(20000);
  __atomic_store_n(&line[0], 77, __ATOMIC_RELEASE);
  CHECK(end_spe(&spe) == 77);
  puts("ok");
  return 0;
}
