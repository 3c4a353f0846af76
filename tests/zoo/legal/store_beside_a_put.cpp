// keeps: store-in-flight
// Stores to the first word while the second is put: an SPU writes the second one back as it was.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t words[4] = {1, 2, 3, 4};

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(&words[1], envp + 4, 4, 3, 0, 0);
  words[0] = 5;
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return words[0] == 5 ? 0 : 1;
}
