/* Its SPE fetches 64 bytes of a block of 40. */
#include "run_in_thread.h"

extern spe_program_handle_t breaks_rules;

__attribute__((noinline)) static void* make_block(void) {
  int* block = (int*)malloc(40);
  block[0] = 1; /* so that malloc returns to here */
  return block;
}

int main(void) {
  spe_thread_t spe;
  void* block = make_block();
  start_spe(&spe, &breaks_rules, 0, (void*)2, block);
  pthread_join(spe.thread, NULL);
  printf("%d\n", spe.result);
  free(block);
  return spe_context_destroy(spe.context);
}
