// Sleeps on the decrementer. SPE 0 does so envp ticks at a time until signal 1 arrives, and ends with how
// often it slept; with 0 ticks it sleeps at the signal, and ends with how many tens of ticks that took. The
// others sleep envp ticks once and then signal to argp.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static volatile uint32_t signal[4];

static void sleep_for(uint32_t ticks) {
  spu_write_decrementer(ticks);
  spu_read_event_status();
  spu_write_event_ack(MFC_DECREMENTER_EVENT);
}

int main(uint64_t spe_id, uint64_t argp, uint64_t envp) {
  const uint32_t ticks = static_cast<uint32_t>(envp);
  spu_write_event_mask(MFC_DECREMENTER_EVENT);
  if (spe_id != 0) {
    sleep_for(ticks);
    signal[3] = 1;  // where the low four bits are those of the register's address
    mfc_sndsig(&signal[3], argp, 1, 0, 0);
    mfc_write_tag_mask(1u << 1);
    mfc_read_tag_status_all();
    return 0;
  }
  if (ticks == 0) {
    spu_write_decrementer(0xFFFFFFFFu);
    spu_read_signal1();
    return static_cast<int>((0xFFFFFFFFu - spu_read_decrementer()) / 10);
  }
  int sleeps = 0;
  for (; spu_stat_signal1() == 0; ++sleeps) sleep_for(ticks);
  return sleeps;
}
