#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace softcell::ppu {

/// FNV-1a over the numbers, as a hash for tables.
struct HashOfNumbers {
  template <std::size_t kCount>
  std::size_t operator()(const std::array<std::uint32_t, kCount>& numbers) const {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::uint32_t number : numbers) hash = (hash ^ number) * 0x100000001b3u;
    return hash;
  }
};

}  // namespace softcell::ppu
