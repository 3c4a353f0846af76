#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

/// A part of a local store: local-store address of its first byte, and its size.
struct LocalStoreSection {
  std::string_view kind;  ///< environment, text, rodata, data, bss, free or stack
  std::uint32_t begin = 0;
  std::uint32_t bytes = 0;

  bool operator==(const LocalStoreSection&) const = default;
};

/// The sections of a local store while the image is loaded, in order of address, without empty ones. Bytes
/// between two sections are alignment.
std::vector<LocalStoreSection> local_store_map(const KernelImage& image);

}  // namespace softcell::ls_sim
