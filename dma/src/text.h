#pragma once
// How numbers are written in fault messages.

#include <cstdint>
#include <string>

#include "softcell/dma/addresses.h"

namespace softcell::dma {

/// 0x-prefixed, upper case, at least `digits` digits.
std::string hex(std::uint64_t value, int digits = 1);

inline std::string to_text(LocalStoreAddress lsa) { return hex(lsa.value, 5); }
inline std::string to_text(EffectiveAddress ea) { return hex(ea.value, 12); }

/// "1 byte", "16 bytes".
inline std::string byte_count(std::uint64_t bytes) {
  return std::to_string(bytes) + (bytes == 1 ? " byte" : " bytes");
}

}  // namespace softcell::dma
