#include <sched.h>

#include "run_in_thread.h"

extern spe_program_handle_t echoes;

#define SPES 4
#define ROUNDS 50

int main(void) {
  spe_thread_t spes[SPES];
  int i, round;
  for (i = 0; i < SPES; ++i) start_spe(&spes[i], &echoes, 0, NULL, NULL);
  for (round = 1; round <= ROUNDS; ++round) {
    for (i = 0; i < SPES; ++i) {
      unsigned int value = (unsigned int)(round * 10 + i);
      CHECK(spe_in_mbox_write(spes[i].context, &value, 1, SPE_MBOX_ALL_BLOCKING) == 1);
    }
    for (i = 0; i < SPES; ++i) {
      unsigned int sent = (unsigned int)(round * 10 + i), answer = 0, doubled = 0;
      while (spe_out_mbox_status(spes[i].context) == 0) sched_yield();
      CHECK(spe_out_mbox_read(spes[i].context, &answer, 1) == 1);
      CHECK(spe_out_intr_mbox_read(spes[i].context, &doubled, 1, SPE_MBOX_ALL_BLOCKING) == 1);
      CHECK(answer == sent + 1 && doubled == 2 * sent);
    }
  }
  for (i = 0; i < SPES; ++i) {
    unsigned int end = 0;
    CHECK(spe_in_mbox_write(spes[i].context, &end, 1, SPE_MBOX_ANY_BLOCKING) == 1);
    CHECK(end_spe(&spes[i]) == ROUNDS);
  }
  puts("ok");
  return 0;
}
