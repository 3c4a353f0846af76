/* Counts in main memory, in rivalry with other SPEs: argp is the address of a lock, a counter that it protects, and a free one. */
#include <libsync.h>
#include <cbe_mfc.h>
#include <stdint.h>

static uint32_t protected_count __attribute__((aligned(16)));

int main(uint64_t id, uint64_t argp) {
  for (int i = 0; i < 100; ++i) {
    mutex_lock(argp);
    mfc_get(&protected_count, argp + 128, 4, 3, 0, 0);
    mfc_write_tag_mask(1 << 3);
    mfc_read_tag_status_all();
    ++protected_count;
    mfc_put(&protected_count, argp + 128, 4, 3, 0, 0);
    mfc_read_tag_status_all();
    mutex_unlock(argp);
    atomic_inc(argp + 256);
    atomic_add(2, argp + 260);
  }
  return atomic_read(argp + 256) < 100;
}
