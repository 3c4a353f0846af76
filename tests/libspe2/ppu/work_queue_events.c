#include "run_in_thread.h"

extern spe_program_handle_t works_off;

#define SPES 3
#define ITEMS 30

static unsigned int items[ITEMS][64] __attribute__((aligned(128)));

int main(void) {
  spe_thread_t spes[SPES];
  spe_event_handler_ptr_t handler = spe_event_handler_create();
  int i, k, next = 0, running = SPES, done = 0;
  CHECK(handler != NULL);
  for (i = 0; i < ITEMS; ++i) {
    for (k = 0; k < 64; ++k) items[i][k] = (unsigned int)(i + k);
  }
  for (i = 0; i < SPES; ++i) {
    spe_event_unit_t event;
    start_spe(&spes[i], &works_off, SPE_EVENTS_ENABLE, (void*)(uintptr_t)(100 + i), NULL);
    event.events = SPE_EVENT_OUT_INTR_MBOX | SPE_EVENT_SPE_STOPPED;
    event.spe = spes[i].context;
    event.data.u32 = (unsigned int)i;
    CHECK(spe_event_handler_register(handler, &event) == 0);
  }
  while (running != 0) {
    spe_event_unit_t events[4];
    int count = spe_event_wait(handler, events, 4, -1);
    CHECK(count > 0);
    for (i = 0; i < count; ++i) {
      if (events[i].events & SPE_EVENT_OUT_INTR_MBOX) {
        unsigned int who = 0, message[2] = {0, 0};
        CHECK(spe_out_intr_mbox_read(events[i].spe, &who, 1, SPE_MBOX_ANY_NONBLOCKING) == 1);
        CHECK(who == 100 + events[i].data.u32);
        if (next < ITEMS) {
          unsigned long long ea = (unsigned long long)(uintptr_t)items[next++];
          message[0] = (unsigned int)(ea >> 32);
          message[1] = (unsigned int)ea;
        }
        CHECK(spe_in_mbox_write(events[i].spe, message, 2, SPE_MBOX_ALL_BLOCKING) == 2);
      }
      if (events[i].events & SPE_EVENT_SPE_STOPPED) {
        spe_stop_info_t stop;
        CHECK(spe_stop_info_read(events[i].spe, &stop) == 0);
        CHECK(stop.stop_reason == SPE_EXIT);
        done += stop.result.spe_exit_code;
        --running;
      }
    }
  }
  for (i = 0; i < SPES; ++i) end_spe(&spes[i]);
  CHECK(done == ITEMS);
  for (i = 0; i < ITEMS; ++i) CHECK(items[i][0] == (unsigned int)(64 * i + 64 * 63 / 2));
  CHECK(spe_event_handler_destroy(handler) == 0);
  puts("ok");
  return 0;
}
