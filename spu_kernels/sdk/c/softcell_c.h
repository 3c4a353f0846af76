/* The Cell language extensions for C kernels on the host; those for C++ are in sdk/host. */
#ifndef SOFTCELL_C_H
#define SOFTCELL_C_H

#if !defined(__AVX2__) || !defined(__FMA__)
#error "kernels are compiled with -mavx2 -mfma"
#endif
#ifndef SOFTCELL_VECTOR_CASTS
#error "C kernels are built by softcell_add_spu_kernel, which gives casts of vectors the SPU's meaning"
#endif

#include "softcell_c_specific.h"

/* Composites. Queues a DMA command; `command` is tid << 24 | rid << 16 | opcode. */
SC_C_INLINE void spu_mfcdma64(volatile void* ls, unsigned int eah, unsigned int eal, unsigned int size,
                              unsigned int tag, unsigned int command) {
  volatile struct softcell_environment* const environment = softcell_environment();
  environment->mfc_lsa = softcell_lsa(ls);
  environment->mfc_eah = eah;
  environment->mfc_eal = eal;
  environment->mfc_size = size;
  environment->mfc_tag = tag;
  softcell_call_gate(softcell_write, MFC_Cmd, command);
}
/* Likewise, for effective addresses below 4 GB. */
SC_C_INLINE void spu_mfcdma32(volatile void* ls, unsigned int ea, unsigned int size, unsigned int tag,
                              unsigned int command) {
  spu_mfcdma64(ls, 0, ea, size, tag, command);
}
/* Waits as MFC_WrTagUpdate's value says (0 immediate, 1 any, 2 all) and returns the complete tag groups of the mask. */
SC_C_INLINE unsigned int spu_mfcstat(unsigned int condition) {
  return softcell_call_gate(softcell_tag_status, 0, condition);
}

#endif
