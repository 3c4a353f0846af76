#ifndef SOFTCELL_PSL1GHT_PPU_LV2_H
#define SOFTCELL_PSL1GHT_PPU_LV2_H
/* Calls of lv2 are functions of softcell here. A number of a call means nothing on a PC: there is no lv2syscall. */

#include <ppu-types.h>

#endif
