// keeps: load-in-flight, store-in-flight
// Waits for the status of a line command by its channel's count, uses the line, and reads the status later.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  while (mfc_stat_atomic_status() == 0) {
  }
  const uint32_t lock = line[0];
  mfc_read_atomic_status();
  mfc_putllc(line, argp, 0, 0);
  const uint32_t beside = line[1];  // the line is only read
  while (mfc_stat_atomic_status() == 0) {
  }
  line[0] = lock + beside;
  mfc_read_atomic_status();
  return 0;
}
