/* Forks while other threads allocate and free; each child allocates, too. */
#include <malloc.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

enum { kForks = 300 };

static volatile int goes_on = 1;

static void* allocates(void* unused) {
  while (goes_on) free(malloc(64));
  return unused;
}

/* What handlers of fork() do that the program has registered. */
static void handler(void) { free(malloc(100)); }

int main(void) {
  pthread_t threads[2];
  int i, failed = 0;
  pthread_atfork(handler, handler, handler);
  for (i = 0; i < 2; ++i) pthread_create(&threads[i], NULL, allocates, NULL);
  for (i = 0; i < kForks && failed < 3; ++i) {
    const pid_t child = fork();
    int status = 0;
    if (child == 0) {
      alarm(10);
      free(malloc(10));
      free(pvalloc(10));
      _exit(0);
    }
    if (waitpid(child, &status, 0) != child || status != 0) ++failed;
  }
  goes_on = 0;
  for (i = 0; i < 2; ++i) pthread_join(threads[i], NULL);
  if (failed != 0) {
    printf("%d children have hung\n", failed);
    return 1;
  }
  printf("ok\n");
  return 0;
}
