#pragma once
// What the kernel saxpy is told: y = a x + y. Seen by the kernel and by the PPU side.

#include <stdint.h>

/// Six 64-bit words, so that `softcell spu run --arg` can write it too. 16-byte aligned.
struct SaxpyJob {
  uint64_t a;      ///< the bits of a float in the lower half
  uint64_t x, y;   ///< effective addresses of `count` floats each, 16-byte aligned
  uint64_t count;  ///< a multiple of 4
  uint64_t spes;   ///< SPEs that share the work: SPE n takes blocks n, n + spes, ...
  uint64_t pad;
};
static_assert(sizeof(SaxpyJob) % 16 == 0, "moved by one DMA command");

/// What main returns. Too many is what does not fit saxpy_no_wait, which has no blocks.
enum SaxpyStatus { kSaxpyDone = 0, kSaxpyCountNotMultipleOf4 = 1, kSaxpyNoSpes = 2, kSaxpyTooMany = 3 };
