#pragma once
// What the plans of the kernels match, match_2d and match_tiles share: groups of four, and lists by which
// sums are made. Plain data, the same bytes for both sides.
//
// A kernel works on two buffers of slots: a slot is the payload of a particle, a bar, a plate or a region,
// some quadwords. Slot 0 is always zero. A sum list is a sequence of halfwords and makes slots 1, 2, 3, ...
// of one buffer from slots of the other, whose numbers are written as offsets in doublewords:
//
//     chain:  terms (1 or more), steps (0 or more),
//             terms x offset                the first sum is that of these slots
//             steps x (offset, offset)      each further sum is the one before, plus the first, minus the
//                                           second
//     run:    kSumRun + sums (1 or more),
//             sums x (offset, offset, offset)  each is the first slot, plus the second, minus the third
//     end:    0
//
// Runs go on where a chain has left off that began in another list: only the lists of match_tiles have them.

#include <stdint.h>

namespace softcell::spu {

constexpr uint32_t kSumOffsetUnit = 8;  ///< bytes
constexpr uint32_t kSumRun = 0x8000;

/// Particles or regions in groups of four.
constexpr uint32_t groups_of(uint32_t count) { return (count + 3) / 4; }

}  // namespace softcell::spu
