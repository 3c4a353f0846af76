/* Runs one SPU program on several SPEs, each with a block of arguments of its own: what a lab's main() begins with. */
#ifndef SPES_H
#define SPES_H
#include <libspe2.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#define MAX_SPES 8

typedef struct {
  spe_context_ptr_t ctx;
  void *argp, *envp;
  int status;
  pthread_t thread;
} spe_t;

static void* spe_main(void* arg) {
  spe_t* spe = (spe_t*)arg;
  unsigned int entry = SPE_DEFAULT_ENTRY;
  spe_stop_info_t stop;
  spe->status = -1;
  if (spe_context_run(spe->ctx, &entry, 0, spe->argp, spe->envp, &stop) < 0) {
    perror("spe_context_run");
    exit(1);
  }
  if (stop.stop_reason == SPE_EXIT) spe->status = stop.result.spe_exit_code;
  return NULL;
}

static inline void start_spe(spe_t* spe, spe_program_handle_t* program, void* argp, void* envp) {
  spe->argp = argp;
  spe->envp = envp;
  if ((spe->ctx = spe_context_create(0, NULL)) == NULL || spe_program_load(spe->ctx, program) ||
      pthread_create(&spe->thread, NULL, spe_main, spe)) {
    perror("SPE");
    exit(1);
  }
}

static inline int wait_spe(spe_t* spe) {
  pthread_join(spe->thread, NULL);
  spe_context_destroy(spe->ctx);
  return spe->status;
}
#endif
