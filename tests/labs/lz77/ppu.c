#include <string.h>
#include "../spes.h"
#include "lz77.h"

extern spe_program_handle_t lz77_spu;
static unsigned char text[LIMIT], packed[2 * LIMIT], again[LIMIT + 16];

static unsigned int go(char what, unsigned char *in, unsigned int bytes, unsigned char *out) {
  static order_t order __attribute__((aligned(16)));
  spe_t spe;
  unsigned int n = 0;
  order.in = (unsigned long)in;
  order.out = (unsigned long)out;
  order.in_bytes = bytes;
  start_spe(&spe, &lz77_spu, &order, (void *)(unsigned long)what);
  pthread_join(spe.thread, NULL);
  if (spe.status != 0 || spe_out_mbox_read(spe.ctx, &n, 1) != 1) exit(1);
  spe_context_destroy(spe.ctx);
  return n;
}

int main(void) {
  unsigned int n, m;
  for (n = 0; n + 40 < 3000; n += 39) sprintf((char *)text + n, "line %4u of a text that repeats itself.\n", n % 100);
  n = (unsigned int)strlen((char *)text);
  m = go('c', text + 3, n - 3, packed + 5);
  if (m == 0 || m * 2 > n) return printf("%u of %u\n", m, n);
  memset(again, 0x55, sizeof again);
  if (go('x', packed + 5, m, again + 1) != n - 3 || memcmp(again + 1, text + 3, n - 3) != 0) return printf("differs\n");
  if (again[0] != 0x55 || again[n - 2] != 0x55) return printf("wrote beside\n");
  printf("ok\n");
  return 0;
}
