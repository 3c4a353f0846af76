#ifndef RUN_IN_THREAD_H
#define RUN_IN_THREAD_H
/* What such programs have: a thread for each SPE context. */
#include <errno.h>
#include <libspe2.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                                          \
  do {                                                                                            \
    if (!(condition)) {                                                                           \
      fprintf(stderr, "%s:%d: not true: %s (errno %d)\n", __FILE__, __LINE__, #condition, errno); \
      exit(1);                                                                                    \
    }                                                                                             \
  } while (0)

typedef struct spe_thread {
  spe_context_ptr_t context;
  pthread_t thread;
  void *argp, *envp;
  int result;
  spe_stop_info_t stop;
} spe_thread_t;

static inline void* run_context(void* argument) {
  spe_thread_t* thread = (spe_thread_t*)argument;
  unsigned int entry = SPE_DEFAULT_ENTRY;
  thread->result = spe_context_run(thread->context, &entry, 0, thread->argp, thread->envp, &thread->stop);
  return NULL;
}

static inline void start_spe(spe_thread_t* thread, spe_program_handle_t* program, unsigned int flags,
                             void* argp, void* envp) {
  thread->context = spe_context_create(flags, NULL);
  CHECK(thread->context != NULL);
  CHECK(spe_program_load(thread->context, program) == 0);
  thread->argp = argp;
  thread->envp = envp;
  CHECK(pthread_create(&thread->thread, NULL, run_context, thread) == 0);
}

/* Returns the program's exit status. */
static inline int end_spe(spe_thread_t* thread) {
  CHECK(pthread_join(thread->thread, NULL) == 0);
  CHECK(thread->result == 0);
  CHECK(thread->stop.stop_reason == SPE_EXIT);
  CHECK(spe_context_destroy(thread->context) == 0);
  return thread->stop.result.spe_exit_code;
}
#endif
