// rule: deadlock
// names: SPU_RdEventStat
// twin: legal/event_of_the_decrementer
// Waits for the event of a signal that nobody sends.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  spu_write_event_mask(MFC_SIGNAL_NOTIFY_1_EVENT);
  const unsigned int events = spu_read_event_status();  // BROKEN
  spu_write_event_ack(events);
  return 0;
}
