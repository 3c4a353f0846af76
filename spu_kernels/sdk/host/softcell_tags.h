#pragma once
// The tag manager: hands out tag groups, so that parts of a kernel which do not know each other do not share
// one. [LEXT, MFC utilities] documented

#include "../shared/softcell_mfc_constants.h"

namespace softcell_sdk {
/// A set bit is a tag that nobody has. Not zero, so that it lies in the initialised data: bss is not cleared
/// for a job.
inline unsigned int free_tags = 0xFFFFFFFFu;

inline unsigned int reserve_tags(unsigned int count) {
  if (count == 0 || count > 32) return MFC_TAG_INVALID;
  const unsigned int run = 0xFFFFFFFFu >> (32 - count);
  for (unsigned int first = 0; first + count <= 32; ++first) {
    if ((free_tags & run << first) == run << first) {
      free_tags &= ~(run << first);
      return first;
    }
  }
  return MFC_TAG_INVALID;
}

inline unsigned int release_tags(unsigned int first, unsigned int count) {
  if (count == 0 || count > 32 || first > 32 - count) return MFC_TAG_INVALID;
  const unsigned int run = 0xFFFFFFFFu >> (32 - count) << first;
  if ((free_tags & run) != 0) return MFC_TAG_INVALID;
  free_tags |= run;
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
