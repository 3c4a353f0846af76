/* Ends with 0 if all of its memory lies below 4 GB, as code of the console takes for granted. */
#include <libspe2.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static int variable;

int main(int argc, char** argv) {
  int local = argc;
  void* block = malloc(1 << 20);
  const void* all[] = {&variable, &local, block, argv, argv[0]};
  unsigned int i, high = 0;
  for (i = 0; i < sizeof all / sizeof all[0]; i++) high += (uintptr_t)all[i] >> 32 != 0;
  printf("%u of 5 pointers have more than 32 bits, %d SPEs\n", high, spe_cpu_info_get(SPE_COUNT_USABLE_SPES, -1));
  free(block);
  return high != 0;
}
