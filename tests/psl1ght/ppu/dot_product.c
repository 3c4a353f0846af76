#include <sys/spu.h>
#include "check.h"

extern const u8 dots_bin[];
static float a[6 * 256] __attribute__((aligned(128))), b[6 * 256] __attribute__((aligned(128)));

int main(void) {
  sysSpuImage image;
  sysSpuThreadAttribute attribute;
  sysSpuThreadGroupAttribute group_attribute;
  sys_spu_group_t group;
  sys_spu_thread_t threads[6];
  u32 cause, status = 99;
  s32 sum = 0, exit_status;
  int i, round;
  for (i = 0; i < 6 * 256; i++) {
    a[i] = (float)(i % 7);
    b[i] = (float)(i % 3);
  }
  sysSpuThreadAttributeInitialize(attribute);
  sysSpuThreadAttributeName(attribute, "dot");
  CHECK(attribute.nsize == 4);
  sysSpuThreadGroupAttributeInitialize(group_attribute);
  CHECK(sysSpuInitialize(6, 0) == 0);
  CHECK(sysSpuImageImport(&image, dots_bin, SPU_IMAGE_PROTECT) == 0);
  CHECK(sysSpuThreadGroupCreate(&group, 6, 100, &group_attribute) == 0);
  for (i = 0; i < 6; i++) {
    sysSpuThreadArgument argument = {EA(a), EA(b), i, 6};
    CHECK(sysSpuThreadInitialize(&threads[i], group, i, &image, &attribute, &argument) == 0);
  }
  for (round = 0; round < 3; round++) { /* a group may be started again */
    CHECK(sysSpuThreadGroupStart(group) == 0);
    CHECK(sysSpuThreadGroupJoin(group, &cause, &status) == 0);
    CHECK(cause == SPU_THREAD_GROUP_JOIN_ALL_THREADS_EXIT && status == 0);
    sum = 0;
    for (i = 0; i < 6; i++) {
      CHECK(sysSpuThreadGetExitStatus(threads[i], &exit_status) == 0);
      sum += exit_status;
    }
  }
  for (i = 0; i < 6 * 256; i++) sum -= (i % 7) * (i % 3);
  CHECK(sum == 0);
  CHECK(sysSpuThreadGroupDestroy(group) == 0);
  CHECK(sysSpuImageClose(&image) == 0);
  printf("ok\n");
  return 0;
}
