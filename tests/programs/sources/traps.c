/* Fails as its second argument says: 1 divides the smallest integer by -1, 2 calls a null pointer, 3 reads by one. */
#include <limits.h>

static volatile int numerator = INT_MIN, divisor = -1;
static int (*volatile function)(void);
static volatile int* volatile place;

int main(unsigned long long spe, unsigned long long how) {
  (void)spe;
  if (how == 1) return numerator / divisor;
  if (how == 2) return function() + 1;
  return *place;
}
