// Sleeps until a PPU thread has stored something else than 0 into the line at argp, with a plain store; ends with it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile unsigned int line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  spu_write_event_mask(MFC_LLR_LOST_EVENT);
  for (;;) {
    mfc_getllar(line, argp, 0, 0);
    mfc_read_atomic_status();
    if (line[0] != 0) return static_cast<int>(line[0]);
    spu_read_event_status();
    spu_write_event_ack(MFC_LLR_LOST_EVENT);
  }
}
