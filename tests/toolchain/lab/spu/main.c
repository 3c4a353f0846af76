#include <stdio.h>
#include "help.h"
static float numbers[64] __attribute__((aligned(128)));
int main(unsigned long long id, unsigned long long argp, unsigned long long envp) {
  (void)id; (void)envp;
  fetch(numbers, argp, sizeof numbers);
  scale(numbers, 64);
  store(numbers, argp, sizeof numbers);
  printf("the SPU says: %g\n", numbers[1]);
  return 0;
}
