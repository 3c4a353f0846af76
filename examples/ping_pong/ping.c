/* Has an SPE add up numbers. This is how such programs look on the Cell: a thread for each SPE context. */
#include <libspe2.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

extern spe_program_handle_t pong;

static unsigned int numbers[1024] __attribute__((aligned(128)));

static void* run(void* context) {
  unsigned int entry = SPE_DEFAULT_ENTRY;
  if (spe_context_run((spe_context_ptr_t)context, &entry, 0, numbers, NULL, NULL) < 0) {
    perror("spe_context_run");
    exit(1);
  }
  return NULL;
}

int main(void) {
  unsigned int count = 1000, sum = 0, i;
  pthread_t thread;
  spe_context_ptr_t spe = spe_context_create(0, NULL);
  if (spe == NULL || spe_program_load(spe, &pong) != 0) {
    perror("an SPE context");
    return 1;
  }
  for (i = 0; i < count; ++i) numbers[i] = i + 1;
  if (pthread_create(&thread, NULL, run, spe) != 0) return 1;
  spe_in_mbox_write(spe, &count, 1, SPE_MBOX_ALL_BLOCKING);
  while (spe_out_mbox_read(spe, &sum, 1) == 0) {
  }
  pthread_join(thread, NULL);
  spe_context_destroy(spe);
  printf("the sum of 1 to %u is %u\n", count, sum);
  return 0;
}
