/* Programs whose main takes whole registers: all 48 bytes of SPE_RUN_USER_REGS. */
#include "run_in_thread.h"

extern spe_program_handle_t takes_vectors, takes_vectors_in_cxx;

static void run(spe_program_handle_t* program) {
  static unsigned int words[12] __attribute__((aligned(16))) = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  spe_context_ptr_t spe = spe_context_create(0, NULL);
  unsigned int entry = SPE_DEFAULT_ENTRY;
  spe_stop_info_t stop;
  CHECK(spe != NULL && spe_program_load(spe, program) == 0);
  CHECK(spe_context_run(spe, &entry, SPE_RUN_USER_REGS, words, NULL, &stop) == 0);
  CHECK(stop.stop_reason == SPE_EXIT && stop.result.spe_exit_code == 0);
  entry = SPE_DEFAULT_ENTRY;
  CHECK(spe_context_run(spe, &entry, 0, (void*)0x500000006ul, NULL, &stop) == 0);
  CHECK(stop.stop_reason == SPE_EXIT && stop.result.spe_exit_code == 0);
  CHECK(spe_context_destroy(spe) == 0);
}

int main(void) {
  run(&takes_vectors);
  run(&takes_vectors_in_cxx);
  puts("ok");
  return 0;
}
