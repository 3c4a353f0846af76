// keeps: lsa-out-of-range
// build: plain
// The last 128 bytes of the local store, which are the stack's first: nothing reaches past them.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t envp) {
  mfc_put(reinterpret_cast<void*>(uintptr_t{0x3FF80}), envp, 128, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
