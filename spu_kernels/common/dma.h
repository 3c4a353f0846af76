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

/// Calls move(ls, ea, size) for pieces that one command moves. `bytes` is a multiple of 16, 0 included.
template <typename Move>
inline void move_large(void* ls, uint64_t ea, uint32_t bytes, const Move& move) {
  char* place = static_cast<char*>(ls);
  while (bytes != 0) {
    const uint32_t piece = bytes < kMaxTransferBytes ? bytes : kMaxTransferBytes;
    move(place, ea, piece);
    place += piece;
    ea += piece;
    bytes -= piece;
  }
}

/// Queues as many gets as it takes to fetch `bytes` (a multiple of 16, 0 included) to `ls`, all in one tag
/// group.
inline void get_large(void* ls, uint64_t ea, uint32_t bytes, uint32_t tag) {
  move_large(ls, ea, bytes,
             [tag](char* to, uint64_t from, uint32_t size) { mfc_get(to, from, size, tag, 0, 0); });
}

/// The same with fences: the gets begin after all earlier commands of the tag group.
inline void getf_large(void* ls, uint64_t ea, uint32_t bytes, uint32_t tag) {
  move_large(ls, ea, bytes,
             [tag](char* to, uint64_t from, uint32_t size) { mfc_getf(to, from, size, tag, 0, 0); });
}

/// Hints that `bytes` at `ea` will be read or written soon: commands of the tag group that move nothing.
inline void touch_large(uint64_t ea, uint32_t bytes, uint32_t tag) {
  move_large(nullptr, ea, bytes,
             [tag](char*, uint64_t from, uint32_t size) { mfc_sdcrt(from, size, tag, 0, 0); });
}

/// Queues as many puts as it takes to store `bytes` (a multiple of 16, 0 included) from `ls`.
inline void put_large(void* ls, uint64_t ea, uint32_t bytes, uint32_t tag) {
  move_large(ls, ea, bytes,
             [tag](char* from, uint64_t to, uint32_t size) { mfc_put(from, to, size, tag, 0, 0); });
}

}  // namespace softcell::spu
