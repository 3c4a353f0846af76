// rule: ea-not-mapped
// names: get
// twin: legal/whole_effective_address
// Keeps the address in 32 bits, which happened to be enough for PS3 games.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t argp, uint64_t) {
  const uint32_t address = mfc_ea2l(argp);
  mfc_get(buffer, address, sizeof buffer, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
