/* Where a program has its memory: every pointer fits in 32 bits. */
#include <pthread.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/spu.h>
#include "check.h"

static int variable;
static int is_low(const volatile void *pointer) { return (uintptr_t)pointer >> 32 == 0; }

static void *thread_main(void *argument) {
  volatile int local = 1;
  CHECK(is_low(&local) && is_low(argument) && is_low(malloc(100)));
  return (void *)&variable;
}

int main(int argc, char **argv) {
  volatile int local = 0;
  pthread_t threads[8];
  pthread_attr_t attributes;
  int round, i;
  void *big, *mapped, *result;
  CHECK(is_low(&local) && is_low(&variable) && is_low(argv) && is_low(argv[0]) && argc == 1 && argv[1] == NULL);
  CHECK(strstr(argv[0], "low_memory") != NULL);
  big = malloc(64 << 20);
  CHECK(big != NULL && is_low(big) && is_low((char *)big + (64 << 20)));
  memset(big, 1, 64 << 20);
  free(big);
  mapped = mmap(NULL, 1 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  CHECK(mapped != MAP_FAILED && is_low(mapped) && munmap(mapped, 1 << 20) == 0);
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, 256 << 10);
  for (round = 0; round < 100; round++) { /* stacks are used again */
    for (i = 0; i < 8; i++) CHECK(pthread_create(&threads[i], i % 2 ? &attributes : NULL, thread_main, &variable) == 0);
    for (i = 0; i < 8; i++) CHECK(pthread_join(threads[i], &result) == 0 && result == &variable);
  }
  CHECK(sysSpuInitialize(6, 0) == 0);
  printf("ok\n");
  return 0;
}
