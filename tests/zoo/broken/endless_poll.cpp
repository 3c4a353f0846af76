// rule: deadline-exceeded
// twin: legal/bounded_poll
// deadline: 100
// Polls its mailbox instead of reading it, so that nobody sees that it waits for ever.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  while (spu_stat_in_mbox() == 0) {  // BROKEN
  }
  return static_cast<int>(spu_read_in_mbox());
}
