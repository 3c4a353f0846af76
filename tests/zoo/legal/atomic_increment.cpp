// keeps: atomic-alignment, atomic-status-not-expected, atomic-status-not-read, putllc-without-reservation
// A counter in main storage, counted up: each status is read once, and a putllc that failed begins anew.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t line[32];

int main(uint64_t, uint64_t argp, uint64_t) {
  do {
    mfc_getllar(line, argp, 0, 0);
    mfc_read_atomic_status();
    line[0] += 1;
    mfc_putllc(line, argp, 0, 0);
  } while ((mfc_read_atomic_status() & MFC_PUTLLC_STATUS) != 0);
  return line[0] == 1 ? 0 : 1;
}
