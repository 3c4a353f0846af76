// keeps: deadlock
// Waits for an event that will come: the decrementer runs.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) {
  spu_write_event_mask(MFC_DECREMENTER_EVENT);
  spu_write_decrementer(100);
  const unsigned int events = spu_read_event_status();
  spu_write_event_mask(0);
  spu_write_event_ack(events);
  return events == MFC_DECREMENTER_EVENT ? 0 : 1;
}
