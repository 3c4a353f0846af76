#include "run_in_thread.h"

extern spe_program_handle_t calls;

static int times;

static int add(void* ls_base, unsigned int ls_address) {
  const unsigned int word = *(unsigned int*)((char*)ls_base + ls_address);
  unsigned int* arguments = (unsigned int*)((char*)ls_base + (word & 0xFFFFFF));
  CHECK(word >> 24 == 7);
  arguments[0] += arguments[1];
  arguments[1] = (unsigned int)++times;
  return 0;
}

static int refuse(void* ls_base, unsigned int ls_address) {
  (void)ls_base;
  (void)ls_address;
  return 33;
}

int main(void) {
  spe_thread_t spe;
  CHECK(spe_callback_handler_register((void*)add, 16, SPE_CALLBACK_NEW) == 0);
  start_spe(&spe, &calls, 0, NULL, NULL);
  CHECK(end_spe(&spe) == 55);
  CHECK(times == 10);
  CHECK(spe_callback_handler_register((void*)refuse, 16, SPE_CALLBACK_UPDATE) == 0);
  start_spe(&spe, &calls, 0, NULL, NULL);
  CHECK(pthread_join(spe.thread, NULL) == 0);
  CHECK(spe.result == -1 && spe.stop.stop_reason == SPE_CALLBACK_ERROR &&
        spe.stop.result.spe_callback_error == 33);
  CHECK(spe_context_destroy(spe.context) == 0);
  CHECK(spe_callback_handler_deregister(16) == 0);
  puts("ok");
  return 0;
}
