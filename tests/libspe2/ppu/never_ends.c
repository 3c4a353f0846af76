/* Its SPE polls for ever. With an argument the program leaves meanwhile. */
#include <unistd.h>

#include "run_in_thread.h"

extern spe_program_handle_t breaks_rules;

int main(int argc, char** argv) {
  static spe_thread_t spe; /* its thread writes to it when main has returned */
  (void)argv;
  start_spe(&spe, &breaks_rules, 0, (void*)6, NULL);
  if (argc > 1) {
    usleep(20000);
    return 5;
  }
  pthread_join(spe.thread, NULL);
  CHECK(spe.result == -1 && spe.stop.stop_reason == SPE_RUNTIME_FATAL);
  return 0;
}
