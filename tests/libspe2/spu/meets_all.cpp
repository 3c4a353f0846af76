// A barrier of all contexts in the line at argp (word 0: who has come, word 1: rounds, word 2: how many take part); envp
// rounds. Who waits sleeps until its reservation is lost.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile unsigned int line[32];

static void reserve(unsigned long long ea) {
  mfc_getllar(line, ea, 0, 0);
  mfc_read_atomic_status();
}

int main(uint64_t, uint64_t argp, uint64_t envp) {
  spu_write_event_mask(MFC_LLR_LOST_EVENT);
  for (unsigned long long round = 0; round < envp; ++round) {
    unsigned int rounds;
    bool last;
    do {
      reserve(argp);
      rounds = line[1];
      last = line[0] + 1 == line[2];
      line[0] = last ? 0 : line[0] + 1;
      if (last) line[1] = rounds + 1;
      mfc_putllc(line, argp, 0, 0);
    } while ((mfc_read_atomic_status() & MFC_PUTLLC_STATUS) != 0);
    if (last) continue;
    for (;;) {
      spu_write_event_ack(MFC_LLR_LOST_EVENT);
      reserve(argp);
      if (line[1] != rounds) break;
      spu_read_event_status();
    }
  }
  return 0;
}
