#pragma once
// What a real SPU g++ (7 to 9) knows as <spu_intrinsics.h>: declarations only, to be compiled with
// -fsyntax-only. A kernel that this header refuses, a real compiler would refuse as well. The flags are
// SOFTCELL_SPU_CHECK_FLAGS in cmake/SoftcellSpuKernel.cmake.
//
// Every table names the operations as the language extensions do, so that it can be read beside them. [LEXT]
// documented
//   softcell_check_types.h     vector types, constants that must be literals
//   softcell_check_specific.h  si_*: one for each instruction
//   softcell_check_generic.h   spu_*: over all vector types
//   ../shared                  numbers of channels and other constants, the same for the host
//
// Deliberately stricter than a compiler: immediates must be constant expressions where they are written; a
// real compiler also takes what its optimiser makes constant. The comparisons si_df* are the PowerXCell's
// alone, so a compiler for the PS3 does not have them.

#include "../shared/softcell_channels.h"
#include "../shared/softcell_special_values.h"
#include "softcell_check_generic.h"
#include "softcell_check_specific.h"
#include "softcell_check_types.h"
