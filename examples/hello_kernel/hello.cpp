// The smallest kernel that does something: it fetches 16 characters from main memory, makes capitals of their
// small letters, all at once, and puts them back.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(16) static vec_uchar16 text;

/// argp: effective address of the 16 characters, a multiple of 16.
int main(uint64_t, uint64_t argp, uint64_t) {
  const uint32_t tag = 0;
  mfc_write_tag_mask(1u << tag);
  mfc_get(&text, argp, sizeof text, tag, 0, 0);  // queued: the bytes may arrive at any time from now on
  mfc_read_tag_status_all();                     // ... and have arrived here

  const vec_uchar16 is_letter = spu_cmpgt(text, (unsigned char)('a' - 1));
  const vec_uchar16 is_beyond = spu_cmpgt(text, (unsigned char)'z');
  const vec_uchar16 is_small = spu_andc(is_letter, is_beyond);
  text = spu_andc(text, spu_and(is_small, (unsigned char)('a' - 'A')));

  mfc_put(&text, argp, sizeof text, tag, 0, 0);
  mfc_read_tag_status_all();
  return 0;  // anything else says that it has failed
}
