/* What C programs have and C++ has not, or not in that way. */
#include <spu_intrinsics.h>
#include <stddef.h>
#include <stdint.h>

#include "check.h"

struct options {
  int depth;
  const char* name;
  double scale;
};
static struct options defaults = {.scale = 2.5, .name = "default", .depth = 3};
static const int primes[] = {[3] = 7, [0] = 2, 3, 5};
static const char* const names[] = {"zero", "one", "two"};
static int (*operation)(int, int);
static int tentative;
static int tentative = 4;

static int old_style(a, b)
int a;
int b;
{ return a - b; }
static int apply(int (*f)(int, int), int a, int b) { return f(a, b); }
static inline int twice(int class) { return 2 * class; }
static int sum(int n, const int values[n]) {
  int all = 0;
  for (int i = 0; i < n; ++i) all += values[i];
  return all;
}

enum colour { RED, GREEN = 5, BLUE };
static char buffer[64] __attribute__((aligned(16)));

static int counter;
static _Atomic unsigned char flag;

/* One thread runs here: these are plain operations. */
static void atomic_operations(void) {
  long long wide = 5;
  short expected = 1, narrow = 1;
  CHECK(__sync_fetch_and_add(&counter, 3) == 0 && __sync_sub_and_fetch(&counter, 1) == 2);
  CHECK(__sync_bool_compare_and_swap(&counter, 2, 7) && __sync_val_compare_and_swap(&counter, 2, 9) == 7);
  CHECK(__atomic_exchange_n(&wide, 6, __ATOMIC_SEQ_CST) == 5 && __atomic_load_n(&wide, __ATOMIC_ACQUIRE) == 6);
  CHECK(__atomic_compare_exchange_n(&narrow, &expected, 4, 0, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST) && narrow == 4);
  CHECK(!__atomic_compare_exchange_n(&narrow, &expected, 5, 1, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST) && expected == 4);
  flag |= 6;
  flag ^= 2;
  flag += 1;
  __sync_synchronize();
  CHECK(flag == 5 && __atomic_fetch_nand(&counter, 3, __ATOMIC_RELAXED) == 7 && counter == ~3);
}

/* Old C makes an external function of it, newer C of none that is inline without extern. It is not inlined here. */
inline int steps_to_one(unsigned int n) {
  return n < 2 ? 0 : 1 + (n % 2 == 0 ? steps_to_one(n / 2) : steps_to_one(3 * n + 1));
}
static int (*const volatile counts_steps)(unsigned int) = steps_to_one;

int main(void) {
  enum colour c = 5;
  void* anything = buffer;
  char* text = anything;
  int new = 3, this = 4;
  operation = old_style;
  CHECK(counts_steps(27) == 111 && steps_to_one(6) == 8);
  CHECK(defaults.depth == 3 && defaults.scale == 2.5 && defaults.name[0] == 'd');
  CHECK(primes[0] == 2 && primes[2] == 5 && primes[3] == 7);
  CHECK(names[2][1] == 'w' && tentative == 4);
  CHECK(apply(operation, 9, 4) == 5 && twice(21) == 42 && new + this == 7);
  CHECK(sum(3, (int[]){1, 2, 3}) == 6);
  CHECK((&(struct options){.depth = 8})->depth == 8);
  CHECK(c == GREEN && ++c == BLUE);
  CHECK(text == buffer && (uint32_t)&buffer[1] - (uint32_t)buffer == 1);
  CHECK((char*)(uint32_t)buffer == buffer);
  CHECK(sizeof(long) == 4 && sizeof(void*) == 4 && sizeof(size_t) == 4 && sizeof(long long) == 8 &&
        (char)-1 > 0);
  CHECK(offsetof(struct options, scale) == 8 && _Alignof(struct options) == 8);
  switch (c) {
    case RED:
      CHECK(0);
      break;
    default:;
      int declared_late = 1;
      CHECK(declared_late);
  }
  atomic_operations();
  return failures;
}
