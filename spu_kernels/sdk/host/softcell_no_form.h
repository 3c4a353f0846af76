#pragma once
// What the compiler says of an intrinsic that is called with operands of other types than it has forms for: one sentence, as a compiler for
// the SPU has it, in place of a list of all candidates. A function with an ellipsis is taken only where no other can be.
// And the forms for qwords.

#include "../shared/softcell_generic_names.h"
#include "softcell_compare.h"
#include "softcell_convert.h"
#include "softcell_double.h"
#include "softcell_estimate.h"
#include "softcell_integer.h"
#include "softcell_lanes.h"
#include "softcell_logic.h"
#include "softcell_quadword.h"
#include "softcell_shift.h"
#include "softcell_shuffle.h"
#include "softcell_single.h"

namespace softcell_sdk {
/// Stands for whatever the caller expects, so that the sentence is all that is said.
struct Anything {
  template <class T_>
  operator T_() const;
};
}  // namespace softcell_sdk

#define SC_SDK_NO_FORM(name) SOFTCELL_HAS_NO_FORM(name) softcell_sdk::Anything spu_##name(...);
SOFTCELL_GENERIC_NAMES(SC_SDK_NO_FORM)
#undef SC_SDK_NO_FORM

// For an SPU's compiler a qword is a vec_char16, also where it is the operand of a generic intrinsic.
namespace softcell_sdk {
template <class T_>
inline constexpr bool kIsQword = false;
template <>
inline constexpr bool kIsQword<qword> = true;
template <class T_>
SC_SDK_INLINE auto with_lanes(T_ operand) {
  if constexpr (kIsQword<T_>) {
    return vec_char16(operand);
  } else {
    return operand;
  }
}
}  // namespace softcell_sdk
#define SC_SDK_OF_QWORDS(name)                                                                    \
  template <class... Operands_, softcell_sdk::If<(softcell_sdk::kIsQword<Operands_> || ...)> = 0> \
  SC_SDK_INLINE auto spu_##name(Operands_... operands_) {                                         \
    return spu_##name(softcell_sdk::with_lanes(operands_)...);                                    \
  }
SOFTCELL_GENERIC_NAMES(SC_SDK_OF_QWORDS)
#undef SC_SDK_OF_QWORDS
