// Adds 1 to the word at argp, envp times.
#include "atomic_line.h"

static AtomicLine line;

int main(uint64_t, uint64_t argp, uint64_t envp) {
  for (uint64_t i = 0; i < envp; ++i) {
    do {
      line.reserve(argp);
      line.words[0] = line.words[0] + 1;
    } while (!line.store(argp));
  }
  return 0;
}
