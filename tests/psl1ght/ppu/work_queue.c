#include <sys/event_queue.h>
#include <sys/spu.h>
#include "check.h"

extern const u8 works_bin[];

int main(void) {
  sysSpuImage image;
  sysSpuThreadAttribute attribute = {"worker", 7, SPU_THREAD_ATTR_NONE};
  sysSpuThreadGroupAttribute group_attribute = {8, "workers", 0, {0}};
  sys_event_queue_attr_t to_spus = {SYS_EVENT_QUEUE_FIFO, SYS_EVENT_QUEUE_SPU, "work"};
  sys_event_queue_attr_t to_ppu = {SYS_EVENT_QUEUE_PRIO, SYS_EVENT_QUEUE_PPU, "answers"};
  sys_event_queue_t work, answers;
  sys_event_port_t port;
  sys_spu_group_t group;
  sys_spu_thread_t threads[4];
  sys_event_t event;
  u32 cause, i, sum = 0, ends = 0;
  u8 end_port = 0;
  CHECK(sysSpuInitialize(6, 0) == 0);
  CHECK(sysSpuImageImport(&image, works_bin, SPU_IMAGE_PROTECT) == 0);
  CHECK(sysEventQueueCreate(&work, &to_spus, 0x100, 64) == 0);
  CHECK(sysEventQueueCreate(&answers, &to_ppu, SYS_EVENT_QUEUE_KEY_LOCAL, 64) == 0);
  CHECK(sysEventPortCreate(&port, SYS_EVENT_PORT_LOCAL, 0xABCDEF) == 0);
  CHECK(sysEventPortConnectLocal(port, work) == 0);
  CHECK(sysSpuThreadGroupCreate(&group, 4, 200, &group_attribute) == 0);
  for (i = 0; i < 4; i++) {
    sysSpuThreadArgument argument = {i, i % 2, 0, 0};
    CHECK(sysSpuThreadInitialize(&threads[i], group, i, &image, &attribute, &argument) == 0);
    CHECK(sysSpuThreadBindQueue(threads[i], work, 7) == 0);
    CHECK(sysSpuThreadConnectEvent(threads[i], answers, SPU_THREAD_EVENT_USER, 3) == 0);
  }
  CHECK(sysSpuThreadGroupConnectEventAllThreads(group, answers, 0x18, &end_port) == 0); /* 3 or 4; 3 is taken */
  CHECK(end_port == 4);
  CHECK(sysSpuThreadGroupStart(group) == 0);
  for (i = 0; i < 20; i++) CHECK(sysEventPortSend(port, 1 + 50 * i, 50, 0) == 0);
  for (i = 0; i < 20; i++) {
    CHECK(sysEventQueueReceive(answers, &event, 0) == 0);
    CHECK(event.source == SPU_THREAD_EVENT_USER_KEY && event.data_2 >> 32 == 3);
    CHECK(event.data_1 >= threads[0] && event.data_1 <= threads[3]);
    CHECK((event.data_2 & 0xFFFFFF) % 50 == 1);
    sum += (u32)event.data_3;
  }
  CHECK(sum == 1000 * 1001 / 2);
  for (i = 0; i < 4; i++) CHECK(sysEventPortSend(port, 0, 0, 77) == 0);
  for (i = 0; i < 4; i++) {
    CHECK(sysEventQueueReceive(answers, &event, 30000000) == 0);
    CHECK(event.data_2 >> 32 == 4 && event.data_3 == 77);
    ends |= 1u << (event.data_2 & 0xFF);
  }
  CHECK(ends == 15);
  CHECK(sysSpuThreadGroupJoin(group, &cause, NULL) == 0 && cause == SPU_THREAD_GROUP_JOIN_ALL_THREADS_EXIT);
  CHECK(sysSpuThreadGroupDisonnectEventAllThreads(group, end_port) == 0);
  CHECK(sysEventPortDisconnect(port) == 0 && sysEventPortDestroy(port) == 0);
  CHECK(sysSpuThreadGroupDestroy(group) == 0);
  CHECK(sysEventQueueDestroy(work, 0) == 0 && sysEventQueueDestroy(answers, 0) == 0);
  CHECK(sysSpuImageClose(&image) == 0);
  printf("ok\n");
  return 0;
}
