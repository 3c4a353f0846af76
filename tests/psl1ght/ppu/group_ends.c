#include <sys/spu.h>
#include "check.h"

extern const u8 ends_bin[];
static sysSpuImage image;
static volatile u32 place[4] __attribute__((aligned(16)));

static sys_spu_group_t start(u32 count, const u32 *how, sys_spu_thread_t *threads) {
  sysSpuThreadAttribute attribute = {"ends", 5, SPU_THREAD_ATTR_NONE};
  sysSpuThreadGroupAttribute group_attribute = {5, "ends", 0, {0}};
  sys_spu_group_t group;
  u32 i;
  CHECK(sysSpuThreadGroupCreate(&group, count, 100, &group_attribute) == 0);
  for (i = 0; i < count; i++) {
    sysSpuThreadArgument argument = {how[i], EA(place), 0, 0};
    CHECK(sysSpuThreadInitialize(&threads[i], group, i, &image, &attribute, &argument) == 0);
  }
  CHECK(sysSpuThreadGroupStart(group) == 0);
  return group;
}

int main(void) {
  static const u32 together[3] = {0, 3, 0}, by_one[3] = {2, 1, 2}, never[2] = {2, 2}, talks[1] = {4};
  sys_spu_thread_t threads[3];
  sys_spu_group_t group;
  u32 cause, status;
  s32 exit_status;
  u64 value = 0;
  CHECK(sysSpuInitialize(6, 0) == 0 && sysSpuImageImport(&image, ends_bin, 0) == 0);

  group = start(3, together, threads);
  CHECK(sysSpuThreadGroupJoin(group, &cause, &status) == 0 && cause == SPU_THREAD_GROUP_JOIN_ALL_THREADS_EXIT);
  CHECK(sysSpuThreadGetExitStatus(threads[0], &exit_status) == 0 && exit_status == 10);
  CHECK(sysSpuThreadGetExitStatus(threads[1], &exit_status) == 0 && exit_status == 13);
  CHECK(sysSpuThreadGroupDestroy(group) == 0);

  group = start(3, by_one, threads);
  CHECK(sysSpuThreadGroupJoin(group, &cause, &status) == 0 && cause == SPU_THREAD_GROUP_JOIN_GROUP_EXIT && status == 11);
  CHECK(sysSpuThreadGetExitStatus(threads[0], &exit_status) != 0); /* it was ended */
  CHECK(sysSpuThreadGroupDestroy(group) == 0);

  group = start(2, never, threads);
  CHECK(sysSpuThreadGroupDestroy(group) == (s32)0x8001000A);
  CHECK(sysSpuThreadGroupYield(group) == 0);
  CHECK(sysSpuThreadGroupTerminate(group, 12) == 0);
  CHECK(sysSpuThreadGroupJoin(group, &cause, &status) == 0 && cause == SPU_THREAD_GROUP_JOIN_TERMINATED && status == 12);
  CHECK(sysSpuThreadGroupTerminate(group, 12) == (s32)0x8001000F);
  CHECK(sysSpuThreadGroupDestroy(group) == 0);

  group = start(1, talks, threads);
  while (place[0] == 0) {
  }
  CHECK(sysSpuThreadReadLocalStorage(threads[0], place[0], &value, 8) == 0 && value == 0x0102030405060708ull);
  CHECK(sysSpuThreadReadLocalStorage(threads[0], place[0], &value, 2) == 0 && value == 0x0708);
  CHECK(sysSpuThreadWriteLocalStorage(threads[0], place[0], 9, 8) == 0);
  CHECK(sysSpuThreadSetConfiguration(threads[0], SPU_SIGNAL1_OR) == 0);
  CHECK(sysSpuThreadWriteSignal(threads[0], 0, 1) == 0 && sysSpuThreadWriteSignal(threads[0], 0, 2) == 0);
  CHECK(sysSpuThreadWriteMb(threads[0], 100) == 0 && sysSpuThreadWriteMb(threads[0], 50) == 0);
  CHECK(sysSpuThreadGroupJoin(group, NULL, NULL) == 0);
  CHECK(sysSpuThreadGetExitStatus(threads[0], &exit_status) == 0 && exit_status == 151 + 0x300);
  CHECK(sysSpuThreadWriteMb(threads[0], 1) == (s32)0x8001000F);
  CHECK(sysSpuThreadGroupDestroy(group) == 0);
  printf("ok\n");
  return 0;
}
