#include <sys/spu.h>
#include "check.h"

extern const u8 halts_bin[];

static u32 status_at_the_end(sys_raw_spu_t spu) {
  u32 status;
  while ((status = sysSpuRawReadProblemStorage(spu, SPU_Status)) & 1) {
  }
  return status;
}

int main(void) {
  sysSpuImage image;
  sys_raw_spu_t spu;
  u64 stat = 0;
  CHECK(sysSpuInitialize(6, 1) == 0 && sysSpuImageImport(&image, halts_bin, 0) == 0);
  CHECK(sysSpuRawCreate(&spu, NULL) == 0 && sysSpuRawImageLoad(spu, &image) == 0);
  /* The PPU side stops it: neither a stop nor a halt of its own. */
  sysSpuRawWriteProblemStorage(spu, SPU_RunCtrl, 1);
  sysSpuRawWriteProblemStorage(spu, SPU_RunCtrl, 0);
  CHECK(status_at_the_end(spu) == 0);
  CHECK(sysSpuRawGetIntStat(spu, 2, &stat) == 0 && stat == 0);
  sysSpuRawWriteProblemStorage(spu, SPU_RunCtrl, 1);
  sysSpuRawWriteProblemStorage(spu, SPU_In_MBox, 1);
  CHECK(status_at_the_end(spu) == 4);
  CHECK(sysSpuRawGetIntStat(spu, 2, &stat) == 0 && stat == 4);
  CHECK(sysSpuRawDestroy(spu) == 0 && sysSpuImageClose(&image) == 0);
  printf("ok\n");
  return 0;
}
