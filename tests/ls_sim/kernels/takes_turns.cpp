// Waits until the line at argp says that it is its turn, envp >> 8, which it counts up. Ends with the low
// byte of envp.
#include "atomic_line.h"

static AtomicLine turn;

int main(uint64_t, uint64_t argp, uint64_t envp) {
  spu_write_event_mask(MFC_LLR_LOST_EVENT);
  for (;;) {
    spu_write_event_ack(MFC_LLR_LOST_EVENT);
    turn.reserve(argp);
    if (turn.words[0] != envp >> 8) {
      spu_read_event_status();
      continue;
    }
    ++turn.words[0];
    if (turn.store(argp)) break;
  }
  spu_write_event_ack(MFC_LLR_LOST_EVENT);
  spu_write_event_mask(0);
  return static_cast<int>(envp & 0xFF);
}
