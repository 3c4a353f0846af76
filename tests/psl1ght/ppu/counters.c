#include <sys/spu.h>
#include "check.h"

#define THREADS 4
#define BYTES 40007
extern const u8 counts_bin[];
static struct {
  u32 ones, threes, less, unused;
  u64 long_ones, high;
  u32 rest[24];
} shared __attribute__((aligned(128)));
static u8 own[THREADS][128] __attribute__((aligned(128)));
static u8 from[BYTES] __attribute__((aligned(128))), to[THREADS][40064] __attribute__((aligned(128)));

int main(void) {
  sysSpuImage image;
  sysSpuThreadAttribute attribute;
  sysSpuThreadGroupAttribute group_attribute;
  sys_spu_group_t group;
  sys_spu_thread_t threads[THREADS];
  u32 cause, status = 99;
  s32 exit_status;
  int i, j;
  for (i = 0; i < BYTES; i++) from[i] = (u8)i;
  sysSpuThreadAttributeInitialize(attribute);
  sysSpuThreadGroupAttributeInitialize(group_attribute);
  CHECK(sysSpuInitialize(6, 0) == 0);
  CHECK(sysSpuImageImport(&image, counts_bin, SPU_IMAGE_PROTECT) == 0);
  CHECK(sysSpuThreadGroupCreate(&group, THREADS, 100, &group_attribute) == 0);
  for (i = 0; i < THREADS; i++) {
    sysSpuThreadArgument argument = {EA(&shared), EA(own[i]), EA(from), EA(to[i])};
    CHECK(sysSpuThreadInitialize(&threads[i], group, i, &image, &attribute, &argument) == 0);
  }
  CHECK(sysSpuThreadGroupStart(group) == 0);
  CHECK(sysSpuThreadGroupJoin(group, &cause, &status) == 0);
  for (i = 0; i < THREADS; i++) {
    CHECK(sysSpuThreadGetExitStatus(threads[i], &exit_status) == 0);
    if (exit_status != 0) printf("counts.c:%d is not true\n", exit_status);
    for (j = 0; j < BYTES; j++) CHECK(to[i][j] == (u8)(j + 1));
    CHECK(to[i][BYTES] == 0);
  }
  CHECK(shared.ones == 400 && shared.threes == 1200 && shared.less == (u32)-400);
  CHECK(shared.long_ones == 400 && shared.high == (u64)400 << 33);
  CHECK(sysSpuThreadGroupDestroy(group) == 0);
  CHECK(sysSpuImageClose(&image) == 0);
  printf("ok\n");
  return 0;
}
