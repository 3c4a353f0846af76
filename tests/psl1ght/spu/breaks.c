/* Fetches from where nothing is. */
#include <spu_mfcio.h>
static char buffer[16] __attribute__((aligned(16)));
int main(uint64_t a, uint64_t b, uint64_t c, uint64_t d) {
  mfc_get(buffer, 0x7000000000ull, sizeof buffer, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  return buffer[0];
}
