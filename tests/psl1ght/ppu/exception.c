#include <sys/event_queue.h>
#include <sys/spu.h>
#include "check.h"

extern const u8 breaks_bin[];

static u8 memory[128] __attribute__((aligned(128)));

/* What breaks.c does, and what lv2 calls it. */
static const u32 causes[] = {SPU_EXCEPTION_MFC_SEGMENT, SPU_EXCEPTION_DMA_ALIGNMENT, SPU_EXCEPTION_DMA_COMMAND, SPU_EXCEPTION_DMA_ALIGNMENT,
                             SPU_EXCEPTION_HALT};

int main(int argc, char **argv) {
  sysSpuImage image;
  sysSpuThreadAttribute attribute = {"breaks", 7, SPU_THREAD_ATTR_NONE};
  sysSpuThreadGroupAttribute named = {7, "breaks", 0, {0}};
  sysSpuThreadArgument argument = {0, 0, 0, 0};
  sys_event_queue_attr_t ppu = {SYS_EVENT_QUEUE_FIFO, SYS_EVENT_QUEUE_PPU, "q"};
  sys_event_queue_t queue;
  sys_event_t event;
  sys_spu_group_t group;
  sys_spu_thread_t thread;
  u32 cause, status, what;
  (void)argv;
  CHECK(sysSpuInitialize(6, 0) == 0 && sysSpuImageImport(&image, breaks_bin, 0) == 0);
  CHECK(sysEventQueueCreate(&queue, &ppu, 0, 8) == 0 && sysSpuThreadGroupCreate(&group, 1, 100, &named) == 0);
  CHECK(sysSpuThreadInitialize(&thread, group, 0, &image, &attribute, &argument) == 0);
  if (argc == 1) CHECK(sysSpuThreadGroupConnectEvent(group, queue, SPU_THREAD_GROUP_EVENT_EXCEPTION) == 0);
  for (what = 0; what < sizeof causes / sizeof *causes; ++what) {
    argument.arg0 = what;
    argument.arg1 = (u64)(unsigned long)memory;
    CHECK(sysSpuThreadSetArguments(thread, &argument) == 0);
    CHECK(sysSpuThreadGroupStart(group) == 0);
    CHECK(sysEventQueueReceive(queue, &event, 0) == 0); /* for ever, if nobody connected it */
    CHECK(event.source == SPU_THREAD_GROUP_EVENT_EXCEPTION_KEY && event.data_1 == group && event.data_2 == thread);
    CHECK(event.data_3 == causes[what]);
    CHECK(sysSpuThreadGroupJoin(group, &cause, &status) == 0 && cause == SPU_THREAD_GROUP_JOIN_TERMINATED);
  }
  printf("ok\n");
  return 0;
}
