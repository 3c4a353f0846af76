// keeps: size-not-legal
// Exactly 16384 bytes, the most that one command moves.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static uint32_t table[4096];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(table, argp, sizeof table, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return table[4095] == 4095 ? 0 : 1;
}
