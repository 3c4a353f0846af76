// keeps: size-not-legal
// A record of six words, padded to a multiple of 16.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct alignas(16) Record {
  uint32_t words[6];
};
static Record record;

int main(uint64_t, uint64_t argp, uint64_t) {
  static_assert(sizeof record == 32, "padded");
  mfc_get(&record, argp, sizeof record, 0, 0, 0);
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return record.words[5] == 5 ? 0 : 1;
}
