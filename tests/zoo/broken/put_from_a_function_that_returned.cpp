// rule: store-in-flight
// names: put
// twin: legal/wait_in_the_function_of_the_buffer
// build: checked
// Sends a message from a variable of a function that returns before the put is complete: what is called next stores there.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static __attribute__((noinline)) void send(uint64_t ea, uint32_t value) {
  alignas(16) volatile uint32_t message[32];
  for (auto& word : message) word = value;
  mfc_put(message, ea, sizeof message, 3, 0, 0);
}

int main(uint64_t, uint64_t, uint64_t envp) {
  send(envp, 1);
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();  // BROKEN
  return 0;
}
