// rule: list-address
// names: getl
// twin: legal/list_at_multiple_of_8
// Takes the last eight bytes of the local store for a list of two elements.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[256];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getl(buffer, argp, 0x3FFF8u, 16, 5, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
