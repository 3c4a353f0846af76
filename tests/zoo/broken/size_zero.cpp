// rule: size-zero
// names: get
// twin: legal/list_element_size_zero
// Fetches what is left after whole blocks, also when nothing is left.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[128];
static volatile unsigned int count = 1024;

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(buffer, argp, static_cast<unsigned int>(count % 128), 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
