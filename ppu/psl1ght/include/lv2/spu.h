#ifndef SOFTCELL_PSL1GHT_LV2_SPU_H
#define SOFTCELL_PSL1GHT_LV2_SPU_H
/* SPU programs as thread groups and raw SPUs load them. [PSL1GHT, lv2/spu.h] documented
 *
 * All functions return 0, or an error of lv2 (0x8001....). Any thread may call them. */

#include <ppu-types.h>

#define SPU_IMAGE_PROTECT 0x0U
#define SPU_IMAGE_DIRECT 0x1U

#ifdef __cplusplus
extern "C" {
#endif

/* A program. Its members belong to softcell. */
typedef struct _sys_spu_image {
  u32 type;
  u32 entryPoint;
  void* segments;
  u32 segmentCount;
} sysSpuImage;

/* Takes the program whose ELF file lies in memory: what softcell-spu-gcc or softcell_add_spu_kernel makes. Its bytes
 * are copied. ENOEXEC: it is no such program, for the reason on standard error. */
s32 sysSpuImageImport(sysSpuImage* image, const void* elf, u32 type);
/* Threads that were initialized with it keep it. */
s32 sysSpuImageClose(sysSpuImage* image);
/* EBUSY: the raw SPU runs. */
s32 sysSpuRawImageLoad(sys_raw_spu_t spu, sysSpuImage* image);
/* *entry: its entry point. */
s32 sysSpuRawLoad(sys_raw_spu_t spu, const char* path, u32* entry);

#ifdef __cplusplus
}
#endif

#endif
