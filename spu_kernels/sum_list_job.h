#pragma once
// Definitions shared by the plans of match, match_2d and match_tiles: groups of four, whole lines, and sum
// lists. Plain data, the same bytes for both sides.
//
// A kernel works on two buffers of slots. A slot is some quadwords: the payload of a particle, a bar, a plate or a region.
// Slot 0 is always zero. A sum list is a sequence of halfwords. It makes slots 1, 2, 3, ...
// of one buffer from slots of the other. It names them by offsets in words, which reach all of a local store:
//
//     chain:  terms (1 or more), growing, sliding, shrinking (0 or more each),
//             terms x offset                the first sum is that of these slots; each further one is the
//                                           one before it,
//             growing x offset              plus this slot,
//             sliding x (offset, offset)    plus the first, minus the second,
//             shrinking x offset            minus this slot
//     run:    kSumRun + sums (1 or more),
//             sums x (offset, offset, offset)  each is the first slot, plus the second, minus the third
//     end:    0
//
// A chain is a window that slides along a row, from before its beginning to past its end. A run continues a chain
// of another list; only the lists of match_tiles have runs.

#include <stdint.h>

namespace softcell::spu {

constexpr uint32_t kSumOffsetUnit = 4;  ///< bytes
constexpr uint32_t kSumRun = 0x8000;

/// Particles or regions in groups of four.
constexpr uint32_t groups_of(uint32_t count) { return (count + 3) / 4; }

/// Bytes from one body's array to the next body's.
constexpr uint32_t whole_lines(uint32_t bytes) { return (bytes + 127) / 128 * 128; }

}  // namespace softcell::spu
