/* Its SPE reads a buffer before the transfer has been waited for, so that what it prints depends on luck. */
#include "run_in_thread.h"

extern spe_program_handle_t breaks_rules;

static unsigned int words[64] __attribute__((aligned(128))) = {42};

int main(int argc, char** argv) {
  spe_thread_t spe;
  start_spe(&spe, &breaks_rules, 0, (void*)7, words);
  printf("%d\n", end_spe(&spe));
  return argc > 1 ? atoi(argv[1]) : 0;
}
