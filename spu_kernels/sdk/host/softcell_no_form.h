#pragma once
// What the compiler says of an intrinsic that is called with operands of other types than it has forms for: one sentence, as a compiler for
// the SPU has it, in place of a list of all candidates. A function with an ellipsis is taken only where no other can be.

#include "../shared/softcell_generic_names.h"

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
