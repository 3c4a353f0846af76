#pragma once
// Whether a sanitizer makes everything ten times as slow. Tests then take fewer steps, or one scene of many: what a sanitizer finds hangs on
// the code that runs and not on how often, and the builds without one have the whole.

#include "softcell/base/sanitizers.h"

namespace softcell {

inline constexpr bool kSlowBuild = SC_ADDRESS_SANITIZER || SC_THREAD_SANITIZER;

}  // namespace softcell
