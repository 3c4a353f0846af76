// rule: size-not-legal
// names: get
// twin: legal/size_32
// Fetches one record of six words: between 8 and 16384 bytes only multiples of 16 are sizes.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct Record {
  float position[3], velocity[3];
};
alignas(16) static Record record;

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(&record, argp, sizeof record, 0, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
