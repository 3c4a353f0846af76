#include "run_in_thread.h"

extern spe_program_handle_t collects_signals;

int main(void) {
  spe_thread_t spe;
  unsigned int all = 1;
  start_spe(&spe, &collects_signals, SPE_CFG_SIGNOTIFY1_OR, NULL, NULL);
  CHECK(spe_signal_write(spe.context, SPE_SIG_NOTIFY_REG_1, 1) == 0);
  CHECK(spe_signal_write(spe.context, SPE_SIG_NOTIFY_REG_1, 2) == 0);
  CHECK(spe_signal_write(spe.context, SPE_SIG_NOTIFY_REG_1, 8) == 0);
  CHECK(spe_signal_write(spe.context, SPE_SIG_NOTIFY_REG_2, 1) == 0);
  CHECK(spe_signal_write(spe.context, SPE_SIG_NOTIFY_REG_2, 6) == 0);
  CHECK(spe_in_mbox_write(spe.context, &all, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  CHECK(end_spe(&spe) == (11 << 4 | 6));
  puts("ok");
  return 0;
}
