#pragma once
// Padding: bytes of variables that belong to no member of their type. Nobody writes them, and copies copy
// them.

#include <cstdint>
#include <vector>

#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

struct PaddingRange {
  std::uint32_t lsa = 0;
  std::uint32_t bytes = 0;
};

/// The padding of an image's variables, as its debug information describes their types. Empty without it.
std::vector<PaddingRange> padding_of(const KernelImage& image);

}  // namespace softcell::ls_sim
