#include <stdint.h>

static char much[10000];

int main(uint64_t, uint64_t argp, uint64_t) {
  volatile char* p = much;
  p[argp % sizeof much] = 1;
  return 0;
}
