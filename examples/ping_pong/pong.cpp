// Adds up numbers that the PPU side has in its memory.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <stdint.h>

static constexpr unsigned int kMost = 1024;
alignas(128) static unsigned int numbers[kMost];

int main(uint64_t, uint64_t argp, uint64_t) {
  const unsigned int count = spu_read_in_mbox();
  const unsigned int bytes = (count * 4 + 15) / 16 * 16;
  mfc_get(numbers, argp, bytes, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();  // without this line `softcell run --checked` tells where it is missing
  unsigned int sum = 0;
  for (unsigned int i = 0; i < count; ++i) sum += numbers[i];
  spu_write_out_mbox(sum);
  return 0;
}
