// Counts its runs in data and in bss, and writes both counts back: a program's run begins with both as they
// are in the image, a job's with its data.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct alignas(128) Counts {
  uint32_t data, bss, pad[30];
};
static uint32_t in_data = 100;
static uint32_t in_bss;
static Counts counts;

int main(uint64_t, uint64_t argp, uint64_t) {
  counts.data = ++in_data;
  counts.bss = ++in_bss;
  mfc_put(&counts, argp, sizeof counts, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  return 0;
}
