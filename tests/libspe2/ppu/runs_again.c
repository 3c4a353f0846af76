/* A context that runs again finds its local store as the last run left it, until something is loaded. */
#include "run_in_thread.h"

extern spe_program_handle_t counts_runs, counts_runs_in_c;

static int result_of_run(spe_context_ptr_t context) {
  unsigned int entry = SPE_DEFAULT_ENTRY;
  spe_stop_info_t stop;
  CHECK(spe_context_run(context, &entry, 0, NULL, NULL, &stop) == 0);
  CHECK(stop.stop_reason == SPE_EXIT);
  return stop.result.spe_exit_code;
}

int main(void) {
  spe_context_ptr_t context = spe_context_create(0, NULL);
  int i;
  CHECK(context != NULL);
  for (i = 0; i < 2; ++i) {
    CHECK(spe_program_load(context, &counts_runs) == 0);
    CHECK(result_of_run(context) == 61);
    CHECK(result_of_run(context) == 72);
    CHECK(result_of_run(context) == 83);
    CHECK(spe_program_load(context, &counts_runs_in_c) == 0);
    CHECK(result_of_run(context) == 46);
    CHECK(result_of_run(context) == 172);
    CHECK(result_of_run(context) == (298 & 0xFF));
    CHECK(result_of_run(context) == (424 & 0xFF));
  }
  CHECK(spe_context_destroy(context) == 0);
  puts("ok");
  return 0;
}
