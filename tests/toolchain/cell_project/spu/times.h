/* Neither static nor extern, in two sources: of old C both define it, of newer C neither does. */
#include <stdlib.h>
inline unsigned int times(unsigned int a, unsigned int b) {
  unsigned int product = 0, i;
  for (i = 0; i < a; ++i) {
    product += b;
    if (product > 1000000) exit(9);
    if (i % 2 != 0 && product % 2 == 7) product ^= (unsigned int)rand();
  }
  return product;
}
