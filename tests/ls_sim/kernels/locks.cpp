// A lock in the line at argp guards the next line, which is changed by plain transfers: each word of it is
// increased by 1, envp times.
#include "atomic_line.h"

static AtomicLine lock;
alignas(128) static volatile uint32_t guarded[32];

static void acquire(uint64_t ea) {
  for (;;) {
    lock.reserve(ea);
    if (lock.words[0] != 0) continue;
    lock.words[0] = 1;
    if (lock.store(ea)) return;
  }
}

static void release(uint64_t ea) {
  lock.words[0] = 0;
  mfc_putlluc(lock.words, ea, 0, 0);
  mfc_read_atomic_status();
}

int main(uint64_t, uint64_t argp, uint64_t envp) {
  const uint64_t data = argp + 128;
  mfc_write_tag_mask(1u << 3);
  for (uint64_t i = 0; i < envp; ++i) {
    acquire(argp);
    mfc_get(guarded, data, sizeof guarded, 3, 0, 0);
    mfc_read_tag_status_all();
    for (int word = 0; word < 32; ++word) guarded[word] = guarded[word] + 1;
    mfc_put(guarded, data, sizeof guarded, 3, 0, 0);
    mfc_read_tag_status_all();
    release(argp);
  }
  return 0;
}
