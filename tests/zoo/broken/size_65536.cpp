// rule: size-not-legal
// names: get
// twin: legal/size_16384
// Fetches 64 KB at once: the size register has 16 bits, so that the hardware may see 0.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char table[65536];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(table, argp, sizeof table, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
