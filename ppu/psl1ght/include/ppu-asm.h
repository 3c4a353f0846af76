#ifndef SOFTCELL_PSL1GHT_PPU_ASM_H
#define SOFTCELL_PSL1GHT_PPU_ASM_H
/* Accesses of the address space by number. [PSL1GHT, ppu-asm.h] documented */

#include <ppu-types.h>

static __inline__ u32 __read32(u64 address) { return *(vu32*)(uintptr_t)address; }
static __inline__ void __write32(u64 address, u32 value) { *(vu32*)(uintptr_t)address = value; }

#endif
