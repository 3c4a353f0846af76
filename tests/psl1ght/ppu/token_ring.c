#include <sys/spu.h>
#include "check.h"

extern const u8 ring_bin[];

/* Two rings at the same time: each group has thread 0 to 4 of its own. */
int main(void) {
  static u32 results[2][4] __attribute__((aligned(16)));
  sysSpuImage image;
  sysSpuThreadAttribute attribute = {"ring", 5, SPU_THREAD_ATTR_NONE};
  sysSpuThreadGroupAttribute group_attribute = {5, "ring", 0, {0}};
  sys_spu_group_t groups[2];
  sys_spu_thread_t thread;
  u32 cause, status, g, i;
  CHECK(sysSpuInitialize(6, 0) == 0);
  CHECK(sysSpuImageImport(&image, ring_bin, SPU_IMAGE_PROTECT) == 0);
  for (g = 0; g < 2; g++) {
    CHECK(sysSpuThreadGroupCreate(&groups[g], 5, 16, &group_attribute) == 0);
    for (i = 0; i < 5; i++) {
      sysSpuThreadArgument argument = {i, 5, EA(results[g]), 3 + g};
      CHECK(sysSpuThreadInitialize(&thread, groups[g], i, &image, &attribute, &argument) == 0);
    }
  }
  for (g = 0; g < 2; g++) CHECK(sysSpuThreadGroupStart(groups[g]) == 0);
  for (g = 0; g < 2; g++) {
    CHECK(sysSpuThreadGroupJoin(groups[g], &cause, &status) == 0);
    CHECK(cause == SPU_THREAD_GROUP_JOIN_GROUP_EXIT && status == (1 + 2 + 3 + 4 + 5) * (3 + g));
    CHECK(results[g][0] == status);
    CHECK(sysSpuThreadGroupDestroy(groups[g]) == 0);
  }
  printf("ok\n");
  return 0;
}
