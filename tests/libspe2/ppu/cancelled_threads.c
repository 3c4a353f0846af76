/* Threads that are cancelled while they wait: each is joined, and what it waited for can be used again. */
#include "run_in_thread.h"

#include <unistd.h>

extern spe_program_handle_t echoes;

enum { RUN, READ, WRITE, EVENTS, WAYS };

static spe_context_ptr_t spe;
static spe_event_handler_ptr_t handler;
static int way, clean;

static void clean_up(void* unused) {
  (void)unused;
  ++clean;
}

static void* wait_for_it(void* unused) {
  unsigned int entry = SPE_DEFAULT_ENTRY, values[5] = {1, 2, 3, 4, 5};
  spe_event_unit_t event;
  pthread_cleanup_push(clean_up, NULL);
  switch (way) {
    case RUN: /* waits for its mailbox */
      CHECK(pthread_setcanceltype(PTHREAD_CANCEL_ASYNCHRONOUS, NULL) == 0);
      spe_context_run(spe, &entry, 0, NULL, NULL, NULL);
      break;
    case READ:
      spe_out_intr_mbox_read(spe, values, 1, SPE_MBOX_ALL_BLOCKING);
      break;
    case WRITE: /* into room for four */
      spe_in_mbox_write(spe, values, 5, SPE_MBOX_ALL_BLOCKING);
      break;
    default:
      spe_event_wait(handler, &event, 1, -1);
      break;
  }
  pthread_cleanup_pop(0);
  return unused;
}

/* Cancellation that is disabled stays so. */
static void* does_not_end(void* unused) {
  unsigned int value;
  spe_event_unit_t event;
  int before;
  CHECK(pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &before) == 0);
  CHECK(spe_event_wait(handler, &event, 1, 200) == 0);
  value = 7;
  CHECK(spe_in_mbox_write(spe, &value, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  return unused;
}

int main(void) {
  pthread_t thread;
  spe_event_unit_t event;
  void* result;
  handler = spe_event_handler_create();
  for (way = 0; way < WAYS; ++way) {
    spe = spe_context_create(SPE_EVENTS_ENABLE, NULL);
    CHECK(spe != NULL && spe_program_load(spe, &echoes) == 0);
    event.events = SPE_EVENT_OUT_INTR_MBOX;
    event.spe = spe;
    event.data.u32 = 0;
    CHECK(spe_event_handler_register(handler, &event) == 0);
    CHECK(pthread_create(&thread, NULL, wait_for_it, NULL) == 0);
    usleep(50000);
    CHECK(pthread_cancel(thread) == 0);
    CHECK(pthread_join(thread, &result) == 0);
    CHECK(result == PTHREAD_CANCELED && clean == way + 1);
    /* The context still runs a program. */
    if (way != WRITE) {
      unsigned int entry = SPE_DEFAULT_ENTRY, none = 0;
      CHECK(spe_in_mbox_write(spe, &none, 1, SPE_MBOX_ALL_BLOCKING) == 1);
      CHECK(spe_context_run(spe, &entry, 0, NULL, NULL, NULL) == 0);
    }
    CHECK(spe_event_handler_deregister(handler, &event) == 0);
    CHECK(spe_context_destroy(spe) == 0);
  }
  spe = spe_context_create(0, NULL);
  CHECK(pthread_create(&thread, NULL, does_not_end, NULL) == 0);
  usleep(20000);
  CHECK(pthread_cancel(thread) == 0);
  CHECK(pthread_join(thread, &result) == 0 && result == NULL);
  CHECK(spe_in_mbox_status(spe) == 3);
  CHECK(spe_context_destroy(spe) == 0);
  CHECK(spe_event_handler_destroy(handler) == 0);
  puts("ok");
  return 0;
}
