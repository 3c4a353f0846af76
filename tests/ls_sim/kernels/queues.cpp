// A queue of 8 words in the line at argp: word 0 counts what was ever taken, word 1 what was ever added, the
// queue is words 8 to 15. Adds envp numbers, each different from all others', and takes as many; adds what it
// took to words 2 (sum) and 3 (exclusive or) of the next line at the end.
#include "atomic_line.h"

static AtomicLine queue, result;

static bool add(uint64_t ea, uint32_t value) {
  queue.reserve(ea);
  const uint32_t taken = queue.words[0], added = queue.words[1];
  if (added - taken == 8) return false;
  queue.words[8 + added % 8] = value;
  queue.words[1] = added + 1;
  return queue.store(ea);
}

static bool take(uint64_t ea, volatile uint32_t& value) {
  queue.reserve(ea);
  const uint32_t taken = queue.words[0];
  if (queue.words[1] == taken) return false;
  value = queue.words[8 + taken % 8];
  queue.words[0] = taken + 1;
  return queue.store(ea);
}

int main(uint64_t spe_id, uint64_t argp, uint64_t envp) {
  const uint32_t count = static_cast<uint32_t>(envp);
  uint32_t added = 0, taken = 0, sum = 0, mixture = 0;
  volatile uint32_t value = 0;
  while (added < count || taken < count) {
    if (added < count && add(argp, static_cast<uint32_t>(spe_id) * count + added)) ++added;
    if (taken < count && take(argp, value)) {
      ++taken;
      sum += value;
      mixture ^= value;
    }
  }
  do {
    result.reserve(argp + 128);
    result.words[2] = result.words[2] + sum;
    result.words[3] = result.words[3] ^ mixture;
  } while (!result.store(argp + 128));
  return 0;
}
