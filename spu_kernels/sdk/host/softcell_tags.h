#pragma once
// The tag manager: hands out tag groups, so that parts of a kernel which do not know each other do not share
// one. [LEXT, MFC utilities] documented

#define MFC_TAG_INVALID 0xFFFFFFFFu
#define MFC_TAG_VALID 0x00000000u

namespace softcell_sdk {
/// A set bit is a reserved tag.
inline unsigned int reserved_tags = 0;

inline unsigned int reserve_tags(unsigned int count) {
  if (count == 0 || count > 32) return MFC_TAG_INVALID;
  const unsigned int run = 0xFFFFFFFFu >> (32 - count);
  for (unsigned int first = 0; first + count <= 32; ++first) {
    if ((reserved_tags & run << first) == 0) {
      reserved_tags |= run << first;
      return first;
    }
  }
  return MFC_TAG_INVALID;
}

inline unsigned int release_tags(unsigned int first, unsigned int count) {
  if (count == 0 || count > 32 || first > 32 - count) return MFC_TAG_INVALID;
  const unsigned int run = 0xFFFFFFFFu >> (32 - count) << first;
  if ((reserved_tags & run) != run) return MFC_TAG_INVALID;
  reserved_tags &= ~run;
  return MFC_TAG_VALID;
}
}  // namespace softcell_sdk

/// A tag group 0..31 that nobody else has, or MFC_TAG_INVALID.
inline unsigned int mfc_tag_reserve() { return softcell_sdk::reserve_tags(1); }
/// MFC_TAG_VALID, or MFC_TAG_INVALID for a tag that was not reserved.
inline unsigned int mfc_tag_release(unsigned int tag) { return softcell_sdk::release_tags(tag, 1); }
/// The first of `count` tag groups in a row, or MFC_TAG_INVALID.
inline unsigned int mfc_multi_tag_reserve(unsigned int count) { return softcell_sdk::reserve_tags(count); }
inline unsigned int mfc_multi_tag_release(unsigned int first, unsigned int count) {
  return softcell_sdk::release_tags(first, count);
}
