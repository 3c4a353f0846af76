// keeps: reservation-not-used
// A line that is reserved to be looked at, as a poll does, and not changed.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_getllar(line, argp, 0, 0);
  mfc_read_atomic_status();
  return line[1] == 1 ? 0 : 1;
}
