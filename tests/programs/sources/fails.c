/* An assertion that does not hold. */
#include <assert.h>

int main(void) {
  int one = 1;
  assert(one == 2);
  return 0;
}
