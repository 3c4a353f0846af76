/* Counts the runs of its context in initialised data, in bss, and in a block of the heap. Returns all counts. */
#include <stdlib.h>

static int initialised = 1, zero, ends;
static int* block;

static void count_ends(void) { ++ends; }

int main(void) {
  int i;
  if (block == NULL) {
    block = malloc(sizeof *block);
    *block = 0;
  }
  for (i = 0; i < 10; ++i)
    if (atexit(count_ends) != 0) return 255;
  ++*block;
  ++zero;
  ++initialised;
  return initialised * 20 + zero * 5 + *block + ends / 10 * 100;
}
