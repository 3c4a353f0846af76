#pragma once
// How numbers are written in fault messages.

#include <string>

#include "softcell/base/text.h"
#include "softcell/dma/addresses.h"

namespace softcell::dma {

using base::byte_count;
using base::hex;

inline std::string to_text(LocalStoreAddress lsa) { return hex(lsa.value, 5); }
inline std::string to_text(EffectiveAddress ea) { return hex(ea.value, 12); }

}  // namespace softcell::dma
