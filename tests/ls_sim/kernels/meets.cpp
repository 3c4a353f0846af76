// A barrier in the line at argp: word 0 counts who has come, word 1 the rounds that are over, word 2 is how
// many take part. Who comes early sleeps until the line is written. In each of envp rounds every SPE puts the
// round's number to its own line behind the barrier's, meets the others, and finds their numbers.
// Ends with 0, or 1 when it found another number.
#include "atomic_line.h"

static AtomicLine barrier;
alignas(128) static volatile uint32_t mine[32];
alignas(128) static volatile uint32_t theirs[6][32];

static void meet(uint64_t ea) {
  uint32_t round;
  bool last;
  do {
    barrier.reserve(ea);
    round = barrier.words[1];
    last = barrier.words[0] + 1 == barrier.words[2];
    barrier.words[0] = last ? 0 : barrier.words[0] + 1;
    if (last) barrier.words[1] = round + 1;
  } while (!barrier.store(ea));
  if (last) return;
  for (;;) {
    spu_write_event_ack(MFC_LLR_LOST_EVENT);
    barrier.reserve(ea);
    if (barrier.words[1] != round) return;
    spu_read_event_status();
  }
}

int main(uint64_t spe_id, uint64_t argp, uint64_t envp) {
  spu_write_event_mask(MFC_LLR_LOST_EVENT);
  mfc_write_tag_mask(1u);
  for (uint32_t round = 1; round <= envp; ++round) {
    mine[0] = round;
    mfc_put(mine, argp + 128 * (1 + spe_id), sizeof mine, 0, 0, 0);
    mfc_read_tag_status_all();
    meet(argp);
    const uint32_t count = barrier.words[2];
    mfc_get(theirs, argp + 128, 128 * count, 0, 0, 0);
    mfc_read_tag_status_all();
    for (uint32_t spe = 0; spe < count; ++spe) {
      if (theirs[spe][0] != round) return 1;
    }
    meet(argp);
  }
  return 0;
}
