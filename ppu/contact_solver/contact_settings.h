#pragma once
// How often contacts are solved in a substep.

#include "ppu/contact_solver/bounces.h"

namespace softcell::ppu {

/// Many rounds with few iterations of each group, so that impulses of one group reach the others soon. With two rounds of four, and a
/// stiffening of a half, heaps never came to rest (docs/notes/performance.md).
struct ContactSettings {
  int rounds = 4;                 ///< number of passes over all groups
  int iterations = 3;             ///< iterations of each group in a round
  int heavy_iterations = 8;       ///< the same for a group of a body with a heavier rigid one
  int attachment_iterations = 4;  ///< over all attachments, in a round
  /// 0..1: the share of their relative motion that corners of touched cells lose after each round but the last.
  float stiffening = 0.35f;
  BounceSettings bounces = {};
};

}  // namespace softcell::ppu
