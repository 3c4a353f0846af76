// rule: outside-local-store
// twin: legal/last_element_of_an_object
// Steps by bytes where it meant elements: its pointer leaves the 256 KB, and wraps around on the
// hardware.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static volatile unsigned char table[128] = {1};
static volatile uint32_t offset = 300 * 1024;

int main(uint64_t, uint64_t, uint64_t) {
  return table[offset] == 1 ? 1 : 0;  // BROKEN
}
