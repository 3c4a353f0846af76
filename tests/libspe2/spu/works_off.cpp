// Asks for work through the interrupting mailbox (its number), gets an address and puts there the sum of 64 words.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned int item[64];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_write_tag_mask(1u << 1);
  unsigned int done = 0;
  for (;;) {
    spu_write_out_intr_mbox(static_cast<unsigned int>(argp));
    const unsigned int high = spu_read_in_mbox(), low = spu_read_in_mbox();
    const unsigned long long ea = static_cast<unsigned long long>(high) << 32 | low;
    if (ea == 0) return static_cast<int>(done);
    mfc_get(item, ea, sizeof item, 1, 0, 0);
    mfc_read_tag_status_all();
    unsigned int sum = 0;
    for (unsigned int i = 0; i < 64; ++i) sum += item[i];
    item[0] = sum;
    mfc_put(item, ea, 16, 1, 0, 0);
    mfc_read_tag_status_all();
    ++done;
  }
}
