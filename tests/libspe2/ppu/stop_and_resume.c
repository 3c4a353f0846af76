#include "run_in_thread.h"

extern spe_program_handle_t pauses;

int main(void) {
  spe_context_ptr_t spe = spe_context_create(SPE_EVENTS_ENABLE, NULL);
  unsigned int entry = SPE_DEFAULT_ENTRY;
  unsigned long long registers[6] = {0, 0, 40, 0, 2, 0};
  spe_stop_info_t stop;
  CHECK(spe != NULL && spe_program_load(spe, &pauses) == 0);
  CHECK(spe_context_run(spe, &entry, 0, (void*)5, (void*)2, &stop) == 0x11);
  CHECK(stop.stop_reason == SPE_STOP_AND_SIGNAL && stop.result.spe_signal_code == 0x11);
  CHECK(stop.spu_status == (0x11 << 16 | 2));
  CHECK(entry < 0x40000);
  CHECK(spe_context_run(spe, &entry, 0, NULL, NULL, NULL) == 0x12);
  CHECK(spe_context_run(spe, &entry, 0, NULL, NULL, &stop) == 0x13);
  CHECK(spe_context_run(spe, &entry, 0, NULL, NULL, &stop) == 0);
  CHECK(stop.stop_reason == SPE_EXIT && stop.result.spe_exit_code == 10);
  /* A program that has stopped can begin anew, */
  entry = SPE_DEFAULT_ENTRY;
  CHECK(spe_context_run(spe, &entry, SPE_RUN_USER_REGS, registers, NULL, &stop) == 0x11);
  entry = SPE_DEFAULT_ENTRY;
  CHECK(spe_context_run(spe, &entry, SPE_RUN_USER_REGS, registers, NULL, &stop) == 0x11);
  while (spe_context_run(spe, &entry, 0, NULL, NULL, &stop) > 0) {
  }
  CHECK(stop.stop_reason == SPE_EXIT && stop.result.spe_exit_code == 45);
  /* and a context can go while its program is stopped. */
  entry = SPE_DEFAULT_ENTRY;
  CHECK(spe_context_run(spe, &entry, 0, NULL, NULL, &stop) == 0x11);
  CHECK(spe_context_destroy(spe) == 0);
  puts("ok");
  return 0;
}
