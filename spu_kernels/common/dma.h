#pragma once
// Small DMA helpers shared by the kernels.

#include <spu_mfcio.h>
#include <stdint.h>

namespace softcell::spu {

/// Most bytes that one MFC command moves. [CBEA, MFC commands] documented
constexpr uint32_t kMaxTransferBytes = 16384;

/// Blocks until every command of the tag groups in `mask` (bit t is tag t) is complete.
inline void wait_for_tags(uint32_t mask) {
  mfc_write_tag_mask(mask);
  mfc_read_tag_status_all();
}

/// Blocks until every command of one tag group is complete.
inline void wait_for_tag(uint32_t tag) { wait_for_tags(1u << tag); }

/// Queues as many gets as it takes to fetch `bytes` (a multiple of 16, 0 included) to `ls`, all in one tag
/// group.
inline void get_large(void* ls, uint64_t ea, uint32_t bytes, uint32_t tag) {
  char* to = static_cast<char*>(ls);
  while (bytes != 0) {
    const uint32_t piece = bytes < kMaxTransferBytes ? bytes : kMaxTransferBytes;
    mfc_get(to, ea, piece, tag, 0, 0);
    to += piece;
    ea += piece;
    bytes -= piece;
  }
}

/// Likewise puts.
inline void put_large(void* ls, uint64_t ea, uint32_t bytes, uint32_t tag) {
  char* from = static_cast<char*>(ls);
  while (bytes != 0) {
    const uint32_t piece = bytes < kMaxTransferBytes ? bytes : kMaxTransferBytes;
    mfc_put(from, ea, piece, tag, 0, 0);
    from += piece;
    ea += piece;
    bytes -= piece;
  }
}

}  // namespace softcell::spu
