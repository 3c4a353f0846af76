// rule: lsa-out-of-range
// names: get
// twin: legal/last_bytes_of_local_store
// Computes a buffer's place from the top of the local store and forgets its size: emulators wrap around
// to address 0.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(reinterpret_cast<void*>(uintptr_t{0x3FFC0}), argp, 128, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
