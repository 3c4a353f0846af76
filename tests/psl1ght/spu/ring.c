/* A token goes around the threads of a group by DMA between local stores. The first way to make a neighbour's address is
 * with 64 bits, the second cuts the sum to 32. */
#include <spu_mfcio.h>
#include <sys/spu_thread.h>

static volatile uint32_t token[4] __attribute__((aligned(16)));
static uint32_t signal[4] __attribute__((aligned(16))) = {0, 0, 0, 1};

int main(uint64_t rank, uint64_t count, uint64_t result, uint64_t rounds) {
  const uint32_t next = (uint32_t)((rank + 1) % count);
  uint32_t round;
  for (round = 0; round < rounds; round++) {
    uint64_t ea;
    uint32_t narrow;
    if (rank != 0 || round != 0) spu_read_signal2();
    token[0] = token[0] + (uint32_t)rank + 1;
    if (round & 1) {
      narrow = (uint32_t)SPU_THREAD_BASE + (uint32_t)token + (uint32_t)SPU_THREAD_OFFSET * next;
      ea = narrow;
    } else {
      ea = SPU_THREAD_BASE + (uint32_t)token + SPU_THREAD_OFFSET * next;
    }
    mfc_put(token, ea, sizeof token, 8, 0, 0);
    ea = SPU_THREAD_BASE + SPU_THREAD_OFFSET * next + SPU_THREAD_Sig_Notify_2;
    if (round == 0)
      mfc_putf(&signal[3], ea, 4, 8, 0, 0);
    else
      mfc_sndsigf(&signal[3], ea, 8, 0, 0);
    mfc_write_tag_mask(1 << 8);
    mfc_read_tag_status_all();
  }
  if (rank == 0) {
    spu_read_signal2();
    mfc_put(token, result, sizeof token, 8, 0, 0);
    mfc_write_tag_mask(1 << 8);
    mfc_read_tag_status_all();
    spu_thread_group_exit(token[0]);
  }
  spu_thread_exit(0);
  return 0;
}
