// rule: ea-not-mapped
// names: get
// twin: legal/whole_effective_address
// Was never given its data: the address is 0.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];

int main(uint64_t, uint64_t, uint64_t) {
  const uint64_t address = 0;
  mfc_get(buffer, address, sizeof buffer, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
