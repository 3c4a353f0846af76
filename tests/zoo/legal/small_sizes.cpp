// keeps: size-not-legal, ea-alignment
// All four small sizes, each where its size allows it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static volatile uint32_t words[4];

int main(uint64_t, uint64_t argp, uint64_t) {
  volatile unsigned char* const bytes = (volatile unsigned char*)words;
  mfc_get(bytes + 1, argp + 1, 1, 0, 0, 0);
  mfc_get(bytes + 2, argp + 2, 2, 0, 0, 0);
  mfc_get(bytes + 4, argp + 4, 4, 0, 0, 0);
  mfc_get(bytes + 8, argp + 8, 8, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return words[1] == 1 && words[2] == 2 && words[3] == 3 ? 0 : 1;
}
