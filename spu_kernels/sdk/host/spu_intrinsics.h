#pragma once
// The Cell language extensions for kernels that are compiled for the host: generic intrinsics (spu_*),
// specific intrinsics (si_*), vector types, channels. Freestanding C++17 for x86-64 with AVX2 and FMA, GCC
// and Clang; needs -frounding-math and -ffp-contract=off, since kernels run with truncating arithmetic. What
// each file holds is said at its top; where results differ from an SPU's is said at the top of
// softcell_single.h and softcell_double.h.
//
// Names of one letter end in an underscore, in all headers that a program includes: it may have macros such as N.

#ifndef __cplusplus
#include "../c/softcell_c.h"
#else

#if !defined(__AVX2__) || !defined(__FMA__)
#error "kernels are compiled with -mavx2 -mfma"
#endif

#include "softcell_compare.h"
#include "softcell_control.h"
#include "softcell_convert.h"
#include "softcell_double.h"
#include "softcell_environment.h"
#include "softcell_estimate.h"
#include "softcell_integer.h"
#include "softcell_lanes.h"
#include "softcell_logic.h"
#include "softcell_no_form.h"
#include "softcell_operators.h"
#include "softcell_quadword.h"
#include "softcell_shift.h"
#include "softcell_shuffle.h"
#include "softcell_single.h"
#include "softcell_specific.h"
#include "softcell_vectors.h"

namespace softcell_sdk {
/// All channel writes of a command, the last of which queues it.
SC_SDK_INLINE void queue_command(uint32_t ls_address, uint32_t eah, uint32_t eal, uint32_t size, uint32_t tag,
                                 uint32_t command) {
  write_channel<MFC_LSA>(ls_address);
  write_channel<MFC_EAH>(eah);
  write_channel<MFC_EAL>(eal);
  write_channel<MFC_Size>(size);
  write_channel<MFC_TagID>(tag);
  write_channel<MFC_Cmd>(command);
}
}  // namespace softcell_sdk

// ---- composites

/// Queues a DMA command. `command` is tid << 24 | rid << 16 | opcode.
SC_SDK_INLINE void spu_mfcdma64(volatile void* ls, unsigned int eah, unsigned int eal, unsigned int size,
                                unsigned int tag, unsigned int command) {
  softcell_sdk::queue_command(softcell_sdk::local_store_address(ls), eah, eal, size, tag, command);
}
/// Likewise, for effective addresses below 4 GB.
SC_SDK_INLINE void spu_mfcdma32(volatile void* ls, unsigned int ea, unsigned int size, unsigned int tag,
                                unsigned int command) {
  softcell_sdk::queue_command(softcell_sdk::local_store_address(ls), 0, ea, size, tag, command);
}
/// Waits as MFC_WrTagUpdate's value says (0 immediate, 1 any, 2 all) and returns the complete tag groups of
/// the mask.
SC_SDK_INLINE unsigned int spu_mfcstat(unsigned int condition) { return softcell_sdk::tag_status(condition); }

#endif
