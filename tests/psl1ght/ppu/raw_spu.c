#include <sys/spu.h>
#include "check.h"

extern const u8 raw_bin[];

static u32 ask(sys_raw_spu_t spu, u32 value) {
  sysSpuRawWriteProblemStorage(spu, SPU_In_MBox, value);
  while ((sysSpuRawReadProblemStorage(spu, SPU_MBox_Status) & 0xFF) == 0) {
  }
  return sysSpuRawReadProblemStorage(spu, SPU_Out_MBox);
}

static void wait_for_stop(sys_raw_spu_t spu) {
  while (sysSpuRawReadProblemStorage(spu, SPU_Status) & 1) {
  }
}

int main(void) {
  sysSpuImage image;
  sys_raw_spu_t spus[2], none;
  u64 stat = 0, mask = 0;
  u32 value = 0, i;
  static u32 words[4] __attribute__((aligned(16))) = {11, 22, 33, 44};
  CHECK(sysSpuRawCreate(&none, NULL) != 0); /* no room was asked for */
  CHECK(sysSpuInitialize(6, 2) == 0);
  CHECK(sysSpuImageImport(&image, raw_bin, SPU_IMAGE_PROTECT) == 0);
  for (i = 0; i < 2; i++) {
    CHECK(sysSpuRawCreate(&spus[i], NULL) == 0);
    CHECK(sysSpuRawImageLoad(spus[i], &image) == 0);
    CHECK(sysSpuRawSetConfiguration(spus[i], SPU_SIGNAL1_OR) == 0);
    CHECK(sysSpuRawGetConfirugation(spus[i], &value) == 0 && value == SPU_SIGNAL1_OR);
    sysSpuRawWriteProblemStorage(spus[i], SPU_RunCtrl, 1);
    CHECK(sysSpuRawReadProblemStorage(spus[i], SPU_RunCtrl) == 1);
  }
  CHECK(sysSpuRawCreate(&none, NULL) != 0);
  CHECK(sysSpuRawImageLoad(spus[0], &image) == (s32)0x8001000A); /* it runs */
  CHECK(ask(spus[0], 1) == 2 && ask(spus[1], 10) == 20);
  CHECK(ask(spus[0], 3) == 6);
  wait_for_stop(spus[0]);
  CHECK(sysSpuRawReadProblemStorage(spus[0], SPU_Status) == 0x01230002);
  CHECK(sysSpuRawSetIntMask(spus[0], 2, 3) == 0 && sysSpuRawGetIntMask(spus[0], 2, &mask) == 0 && mask == 3);
  CHECK(sysSpuRawGetIntStat(spus[0], 2, &stat) == 0 && stat == 2);
  CHECK(sysSpuRawReadPuintMb(spus[0], &value) == (s32)0x8001000A);
  sysSpuRawWriteProblemStorage(spus[0], SPU_RunCtrl, 1); /* goes on behind the stop */
  CHECK(ask(spus[0], 5) == 10);
  while (sysSpuRawReadPuintMb(spus[0], &value) != 0) {
  }
  CHECK(value == 9);
  /* local store and proxy DMA, high up where nothing of the program lies */
  sysSpuRawWriteLocalStorage(spus[0], 0x20000, 0x12345678);
  CHECK(sysSpuRawReadLocalStorage(spus[0], 0x20000) == 0x12345678);
  sysSpuRawWriteProblemStorage(spus[0], MFC_LSA, 0x20010);
  sysSpuRawWriteProblemStorage(spus[0], MFC_EAH, (u32)(EA(words) >> 32));
  sysSpuRawWriteProblemStorage(spus[0], MFC_EAL, (u32)EA(words));
  sysSpuRawWriteProblemStorage(spus[0], MFC_Size, 16 << 16 | 3);
  sysSpuRawWriteProblemStorage(spus[0], MFC_Class_CMD, 0x40);
  CHECK(sysSpuRawReadProblemStorage(spus[0], MFC_CMD_Status) == 0);
  sysSpuRawWriteProblemStorage(spus[0], Prxy_QueryMask, 1 << 3);
  while (sysSpuRawReadProblemStorage(spus[0], Prxy_TagStatus) != 1 << 3) {
  }
  CHECK(sysSpuRawReadLocalStorage(spus[0], 0x20018) == 33);
  for (i = 0; i < 2; i++) {
    sysSpuRawWriteProblemStorage(spus[i], SPU_Sig_Notify_1, 1);
    sysSpuRawWriteProblemStorage(spus[i], SPU_Sig_Notify_1, 4);
    CHECK(ask(spus[i], 0) == 5);
    wait_for_stop(spus[i]);
    CHECK(sysSpuRawReadProblemStorage(spus[i], SPU_Status) == 0x20040002);
  }
  sysSpuRawWriteProblemStorage(spus[1], SPU_RunCtrl, 1); /* from its begin; it waits for ever */
  CHECK(sysSpuRawDestroy(spus[1]) == 0 && sysSpuRawDestroy(spus[0]) == 0);
  CHECK(sysSpuRawDestroy(spus[0]) == (s32)0x80010005);
  CHECK(sysSpuImageClose(&image) == 0);
  printf("ok\n");
  return 0;
}
