// rule: code-without-sync
// names: overlay
// twin: legal/overlay_with_sync
// build: checked
// Fetches a routine into a buffer, as an overlay is, and calls it without a sync.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

// The checked image is not to call anything in it: it runs where it is copied.
__attribute__((noinline, aligned(128), no_sanitize("thread", "kernel-address"))) static uint32_t routine(
    uint32_t x) {
  return 2 * x + spu_readchcnt(SPU_RdSigNotify1);
}
alignas(128) static char overlay[256];

static void wait() {
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
}

int main(uint64_t, uint64_t argp, uint64_t) {
  using Routine = uint32_t(uint32_t);
  mfc_put(reinterpret_cast<char*>(&routine), argp, 256, 3, 0, 0);
  wait();
  mfc_get(overlay, argp, 256, 3, 0, 0);  // BROKEN
  wait();
  return reinterpret_cast<Routine*>(overlay)(21) == 42 ? 0 : 1;
}
