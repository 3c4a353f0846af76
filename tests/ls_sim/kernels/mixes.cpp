// Correct: makes one line of two others, so that who runs before whom shows. argp: addresses of the two and
// of the result, a line.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct alignas(128) Addresses {
  uint64_t left, right, out, pad[13];
};
static Addresses addresses;
alignas(128) static vec_uint4 left[8];
alignas(128) static vec_uint4 right[8];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_write_tag_mask(1);
  mfc_get(&addresses, argp, sizeof addresses, 0, 0, 0);
  mfc_read_tag_status_all();
  mfc_get(left, addresses.left, sizeof left, 0, 0, 0);
  mfc_get(right, addresses.right, sizeof right, 0, 0, 0);
  mfc_read_tag_status_all();
  for (int i = 0; i < 8; ++i) left[i] = spu_add(spu_add(spu_sl(left[i], 1), left[i]), right[i]);
  mfc_put(left, addresses.out, sizeof left, 0, 0, 0);
  mfc_read_tag_status_all();
  return 0;
}
