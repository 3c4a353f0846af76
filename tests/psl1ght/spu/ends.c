/* Ends as the first argument says: 0 by itself, 1 with the group, 2 never, 3 by main's return, 4 after a word in its mailbox. */
#include <spu_mfcio.h>
#include <sys/spu_thread.h>

static volatile uint64_t mark __attribute__((aligned(16))) = 0x0102030405060708ull;

int main(uint64_t how, uint64_t place, uint64_t c, uint64_t d) {
  switch (how) {
    case 0:
      spu_thread_exit(10);
    case 1:
      spu_thread_group_exit(11);
    case 2:
      spu_read_signal1();
      return 0;
    case 3:
      return 13;
    default: {
      static uint32_t address[4] __attribute__((aligned(16)));
      address[0] = (uint32_t)&mark & 0x3FFFF;
      mfc_put(address, place, 16, 0, 0, 0);
      mfc_write_tag_mask(1);
      mfc_read_tag_status_all();
      spu_thread_exit((int)(spu_read_in_mbox() + spu_read_in_mbox() + (mark == 9) + (spu_read_signal1() << 8)));
    }
  }
}
