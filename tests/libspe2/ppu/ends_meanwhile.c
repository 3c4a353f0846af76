/* Ends while its SPEs run. The process ends with the status of main() or of exit(), whatever its threads would do if
   their runs came back with an error; they do not, as on the Cell. What the program does in its exit handlers finds its
   SPEs alive. Arguments: how it ends; how many SPEs wait for a mailbox. */
#include <unistd.h>

#include "run_in_thread.h"

extern spe_program_handle_t echoes;

static spe_thread_t asked; /* by the exit handler */

static void fail_and_exit(const char* what) {
  perror(what);
  exit(1);
}

static void* run_like_a_tutorial(void* unused) {
  unsigned int entry = SPE_DEFAULT_ENTRY;
  spe_context_ptr_t context = spe_context_create(0, NULL);
  (void)unused;
  if (context == NULL || spe_program_load(context, &echoes) != 0) fail_and_exit("no context");
  if (spe_context_run(context, &entry, 0, NULL, NULL, NULL) < 0) fail_and_exit("Failed running context");
  return NULL;
}

static void* wait_for_its_end(void* handler) {
  spe_event_unit_t event;
  if (spe_event_wait(handler, &event, 1, -1) != 0) fail_and_exit("an SPE has stopped");
  return NULL;
}

static void watch(spe_thread_t* spe) {
  pthread_t thread;
  spe_event_unit_t event;
  spe_event_handler_ptr_t handler = spe_event_handler_create();
  start_spe(spe, &echoes, SPE_EVENTS_ENABLE, NULL, NULL);
  memset(&event, 0, sizeof event);
  event.spe = spe->context;
  event.events = SPE_EVENT_SPE_STOPPED;
  CHECK(spe_event_handler_register(handler, &event) == 0);
  CHECK(pthread_create(&thread, NULL, wait_for_its_end, handler) == 0);
}

static void ask_and_join(void) {
  unsigned int value = 20, answer = 0;
  CHECK(spe_in_mbox_write(asked.context, &value, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  CHECK(spe_out_intr_mbox_read(asked.context, &answer, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  CHECK(answer == 40);
  value = 0;
  CHECK(spe_in_mbox_write(asked.context, &value, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  CHECK(end_spe(&asked) == 1);
  puts("asked");
}

int main(int argc, char** argv) {
  static spe_thread_t watched;
  const char* const way = argc > 1 ? argv[1] : "return";
  const int spes = argc > 2 ? atoi(argv[2]) : 6;
  pthread_t thread;
  int i;
  if (strcmp(way, "handler") == 0) CHECK(atexit(ask_and_join) == 0); /* before the library has any of its own */
  for (i = 0; i < spes; ++i) CHECK(pthread_create(&thread, NULL, run_like_a_tutorial, NULL) == 0);
  watch(&watched);
  if (strcmp(way, "handler") == 0) start_spe(&asked, &echoes, 0, NULL, NULL);
  usleep(50000);
  puts("ok");
  if (strcmp(way, "quick") == 0) {
    fflush(stdout);
    quick_exit(7);
  }
  if (strcmp(way, "exit") == 0) exit(7);
  return 0;
}
