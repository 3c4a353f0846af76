// keeps: size-not-legal, ea-alignment
// All four small sizes, each where its size allows it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static unsigned char bytes[16];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(bytes + 1, argp + 1, 1, 0, 0, 0);
  mfc_get(bytes + 2, argp + 2, 2, 0, 0, 0);
  mfc_get(bytes + 4, argp + 4, 4, 0, 0, 0);
  mfc_get(bytes + 8, argp + 8, 8, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return bytes[4] == 1 && bytes[8] == 2 && bytes[12] == 3 ? 0 : 1;
}
