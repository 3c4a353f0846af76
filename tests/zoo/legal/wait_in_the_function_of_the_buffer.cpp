// keeps: store-in-flight
// Waits before the function returns whose variable is put; functions that are called meanwhile have variables of their own.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static __attribute__((noinline)) void wait_for(uint32_t tag) {
  volatile uint32_t mask = 1u << tag;
  mfc_write_tag_mask(mask);
  mfc_read_tag_status_all();
}

static __attribute__((noinline)) void send(uint64_t ea, uint32_t value) {
  alignas(16) volatile uint32_t message[32];
  for (auto& word : message) word = value;
  mfc_put(message, ea, sizeof message, 3, 0, 0);
  wait_for(3);
}

int main(uint64_t, uint64_t, uint64_t envp) {
  send(envp, 1);
  send(envp + 128, 2);
  return 0;
}
