/* Each function's documented errors. */
#include <errno.h>
#include <string.h>
#include <sys/event_queue.h>
#include <sys/lv2errno.h>
#include <sys/process.h>
#include <sys/spu.h>
#include <sys/systime.h>
#include "check.h"

SYS_PROCESS_PARAM(1001, 0x10000)

extern const u8 ends_bin[];
enum {
  OK = 0,
  EAGAIN_ = (int)0x80010001, INVALID = (int)0x80010002, NOSYS = (int)0x80010003, NO_OBJECT = (int)0x80010005, NO_FILE = (int)0x80010006,
  NOEXEC_ = (int)0x80010007, BUSY = (int)0x8001000A, TIMEOUT = (int)0x8001000B, FAULT = (int)0x8001000D, STATE = (int)0x8001000F,
  EXISTS = (int)0x80010014, CONNECTED = (int)0x80010015, NOT_CONNECTED = (int)0x80010016
};

static void queues(void) {
  sys_event_queue_attr_t ppu = {SYS_EVENT_QUEUE_FIFO, SYS_EVENT_QUEUE_PPU, "q"}, spu = {SYS_EVENT_QUEUE_FIFO, SYS_EVENT_QUEUE_SPU, "s"}, bad = ppu;
  sys_event_queue_t a, b, c;
  sys_event_port_t port;
  sys_event_t event;
  int i;
  bad.type = 3;
  CHECK(sysEventQueueCreate(NULL, &ppu, 0, 1) == FAULT && sysEventQueueCreate(&a, NULL, 0, 1) == FAULT);
  CHECK(sysEventQueueCreate(&a, &ppu, 0, 0) == INVALID && sysEventQueueCreate(&a, &ppu, 0, 128) == INVALID);
  CHECK(sysEventQueueCreate(&a, &bad, 0, 1) == INVALID);
  bad = ppu;
  bad.attr_protocol = 4;
  CHECK(sysEventQueueCreate(&a, &bad, 0, 1) == INVALID);
  CHECK(sysEventQueueCreate(&a, &ppu, 5, 2) == OK && sysEventQueueCreate(&b, &ppu, 5, 2) == EXISTS);
  CHECK(sysEventQueueCreate(&b, &spu, 0, 127) == OK && sysEventQueueCreate(&c, &ppu, 0, 1) == OK);
  CHECK(sysEventQueueReceive(b, &event, 1) == INVALID && sysEventQueueReceive(999, &event, 1) == NO_OBJECT);
  CHECK(sysEventQueueReceive(a, NULL, 1) == FAULT && sysEventQueueReceive(a, &event, 1000) == TIMEOUT);
  CHECK(sysEventPortCreate(&port, 2, 0) == INVALID && sysEventPortCreate(NULL, 1, 0) == FAULT);
  CHECK(sysEventPortCreate(&port, SYS_EVENT_PORT_LOCAL, SYS_EVENT_PORT_NO_NAME) == OK);
  CHECK(sysEventPortSend(port, 1, 2, 3) == NOT_CONNECTED && sysEventPortDisconnect(port) == NOT_CONNECTED);
  CHECK(sysEventPortConnectLocal(port, 999) == NO_OBJECT && sysEventPortConnectLocal(port, a) == OK);
  CHECK(sysEventPortConnectLocal(port, a) == CONNECTED && sysEventPortDestroy(port) == CONNECTED);
  for (i = 0; i < 2; i++) CHECK(sysEventPortSend(port, i, 2, 3) == OK);
  CHECK(sysEventPortSend(port, 1, 2, 3) == BUSY);
  CHECK(sysEventQueueReceive(a, &event, 0) == OK && event.data_1 == 0 && event.data_3 == 3 && (u32)event.source == port);
  CHECK(sysEventQueueDrain(a) == OK && sysEventQueueReceive(a, &event, 10) == TIMEOUT && sysEventQueueDrain(999) == NO_OBJECT);
  CHECK(sysEventQueueDestroy(a, 2) == INVALID && sysEventQueueDestroy(a, 0) == OK && sysEventQueueDestroy(a, 0) == NO_OBJECT);
  CHECK(sysEventPortSend(port, 1, 2, 3) == NOT_CONNECTED);
  CHECK(sysEventPortDisconnect(port) == OK && sysEventPortDestroy(port) == OK && sysEventPortDestroy(port) == NO_OBJECT);
  CHECK(sysEventQueueDestroy(b, SYS_EVENT_QUEUE_FORCE_DESTROY) == OK && sysEventQueueDestroy(c, 0) == OK);
}

static void images(void) {
  sysSpuImage image;
  static const char text[64] = "no ELF file";
  CHECK(sysSpuImageImport(NULL, ends_bin, 0) == FAULT && sysSpuImageImport(&image, NULL, 0) == FAULT);
  CHECK(sysSpuImageImport(&image, ends_bin, 7) == INVALID && sysSpuImageImport(&image, text, 0) == NOEXEC_);
  CHECK(sysSpuImageOpen(&image, "no_such_file") == NO_FILE && sysSpuImageOpen(&image, NULL) == FAULT);
  CHECK(sysSpuImageOpenFd(&image, 9999, 0) != OK);
  CHECK(sysSpuImageImport(&image, ends_bin, 0) == OK && image.entryPoint != 0);
  CHECK(sysSpuImageClose(&image) == OK && sysSpuImageClose(&image) == INVALID && sysSpuImageClose(NULL) == FAULT);
}

static void groups(void) {
  sysSpuThreadAttribute attribute = {"t", 2, SPU_THREAD_ATTR_NONE};
  sysSpuThreadGroupAttribute named = {2, "g", 0, {0}};
  sysSpuThreadArgument argument = {0, 0, 0, 0};
  sys_event_queue_attr_t ppu = {SYS_EVENT_QUEUE_FIFO, SYS_EVENT_QUEUE_PPU, "q"}, spu = {SYS_EVENT_QUEUE_FIFO, SYS_EVENT_QUEUE_SPU, "s"};
  sys_event_queue_t queue, spu_queue;
  sys_event_t event;
  sys_spu_group_t group;
  sys_spu_thread_t thread, other;
  sysSpuImage image;
  u32 priority = 0;
  u64 value = 0;
  s32 status;
  u8 port;
  CHECK(sysSpuInitialize(7, 0) == INVALID && sysSpuInitialize(6, 6) == INVALID && sysSpuInitialize(6, 0) == OK);
  CHECK(sysSpuImageImport(&image, ends_bin, 0) == OK);
  CHECK(sysEventQueueCreate(&queue, &ppu, 0, 8) == OK && sysEventQueueCreate(&spu_queue, &spu, 0, 8) == OK);
  CHECK(sysSpuThreadGroupCreate(NULL, 1, 100, &named) == FAULT && sysSpuThreadGroupCreate(&group, 1, 100, NULL) == FAULT);
  CHECK(sysSpuThreadGroupCreate(&group, 0, 100, &named) == INVALID && sysSpuThreadGroupCreate(&group, 7, 100, &named) == INVALID);
  CHECK(sysSpuThreadGroupCreate(&group, 1, 15, &named) == INVALID && sysSpuThreadGroupCreate(&group, 1, 256, &named) == INVALID);
  CHECK(sysSpuThreadGroupCreate(&group, 2, 100, &named) == OK);
  CHECK(sysSpuThreadGroupStart(group) == STATE && sysSpuThreadGroupJoin(group, NULL, NULL) == STATE);
  CHECK(sysSpuThreadGroupYield(group) == STATE && sysSpuThreadGroupStart(999) == NO_OBJECT);
  CHECK(sysSpuThreadGroupSetPriority(group, 3) == INVALID && sysSpuThreadGroupSetPriority(group, 42) == OK);
  CHECK(sysSpuThreadGroupGetPriority(group, NULL) == FAULT && sysSpuThreadGroupGetPriority(group, &priority) == OK && priority == 42);
  CHECK(sysSpuThreadInitialize(NULL, group, 0, &image, &attribute, &argument) == FAULT);
  CHECK(sysSpuThreadInitialize(&thread, 999, 0, &image, &attribute, &argument) == NO_OBJECT);
  CHECK(sysSpuThreadInitialize(&thread, group, 2, &image, &attribute, &argument) == INVALID);
  CHECK(sysSpuThreadInitialize(&thread, group, 0, &image, &attribute, &argument) == OK);
  CHECK(sysSpuThreadInitialize(&other, group, 0, &image, &attribute, &argument) == BUSY);
  CHECK(sysSpuThreadGroupConnectEventAllThreads(group, queue, 1, &port) == STATE);
  CHECK(sysSpuThreadInitialize(&other, group, 1, &image, &attribute, &argument) == OK);
  CHECK(sysSpuThreadSetArguments(thread, NULL) == FAULT && sysSpuThreadSetArguments(999, &argument) == NO_OBJECT);
  argument.arg0 = 3;
  CHECK(sysSpuThreadSetArguments(thread, &argument) == OK);
  CHECK(sysSpuThreadGetExitStatus(thread, &status) == STATE && sysSpuThreadGetExitStatus(thread, NULL) == FAULT);
  CHECK(sysSpuThreadConnectEvent(thread, queue, SPU_THREAD_EVENT_DMA, 1) == INVALID);
  CHECK(sysSpuThreadConnectEvent(thread, queue, SPU_THREAD_EVENT_USER, 64) == INVALID);
  CHECK(sysSpuThreadConnectEvent(thread, 999, SPU_THREAD_EVENT_USER, 1) == NO_OBJECT);
  CHECK(sysSpuThreadConnectEvent(thread, queue, SPU_THREAD_EVENT_USER, 1) == OK);
  CHECK(sysSpuThreadConnectEvent(thread, queue, SPU_THREAD_EVENT_USER, 1) == CONNECTED);
  CHECK(sysSpuThreadDisconnectEvent(thread, SPU_THREAD_EVENT_USER, 2) == NOT_CONNECTED);
  CHECK(sysSpuThreadDisconnectEvent(thread, SPU_THREAD_EVENT_USER, 1) == OK);
  CHECK(sysSpuThreadBindQueue(thread, queue, 1) == INVALID && sysSpuThreadBindQueue(thread, spu_queue, 1) == OK);
  CHECK(sysSpuThreadBindQueue(thread, spu_queue, 1) == BUSY && sysSpuThreadUnbindQueue(thread, 1) == OK);
  CHECK(sysSpuThreadUnbindQueue(thread, 1) == NO_OBJECT);
  CHECK(sysSpuThreadWriteSignal(thread, 0, 1) == STATE && sysSpuThreadWriteLocalStorage(thread, 0, 0, 4) == STATE);
  CHECK(sysSpuThreadReadLocalStorage(thread, 0, &value, 4) == STATE);
  CHECK(sysSpuThreadSetConfiguration(thread, 4) == INVALID && sysSpuThreadSetConfiguration(thread, 3) == OK);
  CHECK(sysSpuThreadGetConfiguration(thread, &value) == OK && value == 3 && sysSpuThreadGetConfiguration(thread, NULL) == FAULT);
  CHECK(sysSpuThreadGroupConnectEvent(group, queue, 5) == INVALID && sysSpuThreadGroupConnectEvent(group, 999, 1) == NO_OBJECT);
  CHECK(sysSpuThreadGroupConnectEvent(group, queue, SPU_THREAD_GROUP_EVENT_RUN) == OK);
  CHECK(sysSpuThreadGroupConnectEvent(group, queue, SPU_THREAD_GROUP_EVENT_RUN) == CONNECTED);
  CHECK(sysSpuThreadGroupDisconnectEvent(group, SPU_THREAD_GROUP_EVENT_EXCEPTION) == NOT_CONNECTED);
  CHECK(sysSpuThreadGroupSuspend(group) == NOSYS && sysSpuThreadGroupResume(group) == NOSYS);
  CHECK(sysSpuThreadRecoverPageFault(thread) == NOSYS);
  CHECK(sysSpuThreadGroupStart(group) == OK);
  CHECK(sysEventQueueReceive(queue, &event, 0) == OK && event.source == SPU_THREAD_GROUP_EVENT_RUN_KEY && event.data_1 == group);
  CHECK(sysSpuThreadGroupJoin(group, NULL, NULL) == OK && sysSpuThreadGetExitStatus(thread, &status) == OK && status == 13);
  CHECK(sysSpuThreadGroupDisconnectEvent(group, SPU_THREAD_GROUP_EVENT_RUN) == OK);
  CHECK(sysSpuThreadGroupDestroy(group) == OK && sysSpuThreadGroupDestroy(group) == NO_OBJECT);
  CHECK(sysSpuThreadSetArguments(thread, &argument) == NO_OBJECT);
}

int main(void) {
  sys_raw_spu_t raw;
  u64 mask, seconds, nanoseconds;
  freopen("/dev/null", "w", stderr); /* reasons of refusals */
  queues();
  images();
  groups();
  CHECK(sysSpuInitialize(6, 1) == OK && sysSpuRawCreate(NULL, NULL) == FAULT && sysSpuRawCreate(&raw, NULL) == OK);
  CHECK(sysSpuRawSetIntMask(raw, 3, 0) == INVALID && sysSpuRawGetIntMask(raw, 0, NULL) == FAULT && sysSpuRawSetIntStat(raw, 3, 0) == INVALID);
  CHECK(sysSpuRawGetIntStat(raw, 0, &mask) == OK && mask == 0 && sysSpuRawReadPuintMb(raw, NULL) == FAULT);
  CHECK(sysSpuRawSetConfiguration(raw, 8) == INVALID && sysSpuRawImageLoad(raw, NULL) == FAULT);
  CHECK(sysSpuRawCreateInterrupTag(raw, 2, 0, NULL) == NOSYS && sysSpuRawRecoverPageFault(raw) == NOSYS);
  CHECK(sysSpuRawLoad(raw, "no_such_file", (u32 *)&mask) == NO_FILE && sysSpuRawDestroy(77) == NO_OBJECT && sysSpuRawDestroy(raw) == OK);
  CHECK(lv2error(BUSY) == EBUSY && lv2error(7) == 7 && lv2errno(OK) == 0 && lv2errno(TIMEOUT) == -1 && errno == ETIMEDOUT);
  CHECK(sysUsleep(10) == 0 && sysGetCurrentTime(&seconds, &nanoseconds) == 0 && nanoseconds < 1000000000u);
  CHECK(sysGetSystemTime() > 0 && sysGetTimebaseFrequency() == 79800000 && sysProcessGetPid() != 0 && EAGAIN_ != 0);
  printf("ok\n");
  return 0;
}
