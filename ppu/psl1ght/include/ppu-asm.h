#ifndef SOFTCELL_PSL1GHT_PPU_ASM_H
#define SOFTCELL_PSL1GHT_PPU_ASM_H
/* Accesses of the address space by number. [PSL1GHT, ppu-asm.h] documented */

#include <ppu-types.h>

static inline u32 __read32(u64 address) { return *(vu32*)(uintptr_t)address; }
static inline void __write32(u64 address, u32 value) { *(vu32*)(uintptr_t)address = value; }

#endif
