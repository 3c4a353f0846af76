/* Its SPE fetches 64 bytes of pages that the program has mapped where a large block lay that was freed. */
#define _GNU_SOURCE
#include <stdint.h>
#include <sys/mman.h>

#include "run_in_thread.h"

extern spe_program_handle_t breaks_rules;

int main(void) {
  spe_thread_t spe;
  char* volatile block = (char*)malloc(300000);
  void* const page = (void*)(((uintptr_t)block + 4095) & ~(uintptr_t)4095);
  free(block);
  if (mmap(page, 65536, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != page) {
    printf("other pages\n");
    return 1;
  }
  start_spe(&spe, &breaks_rules, 0, (void*)2, page);
  pthread_join(spe.thread, NULL);
  printf("%d\n", spe.result);
  return spe_context_destroy(spe.context);
}
