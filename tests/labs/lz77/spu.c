/* LZ77 both ways in one program: what to do is an argument, data lie anywhere (unaligned ends), output is counted. */
#include <ctype.h>
#include <spu_mfcio.h>
#include <string.h>
#include "lz77.h"

static order_t order __attribute__((aligned(16)));
static unsigned char in[LIMIT + 128] __attribute__((aligned(128))), out[LIMIT + 128] __attribute__((aligned(128)));

static unsigned compress(unsigned n) {
  unsigned i = 0, o = 0;
  while (i < n) {
    unsigned best = 0, from = 0, j, start = i > 255 ? i - 255 : 0;
    for (j = start; j < i; j++) {
      unsigned len = 0;
      while (len < 255 && i + len < n && in[j + len] == in[i + len]) len++;
      if (len > best) {
        best = len;
        from = j;
      }
    }
    if (best < 4) best = 0;
    out[o++] = (unsigned char)(best ? i - from : 0);
    out[o++] = (unsigned char)best;
    if (!best) {
      out[o - 1] = in[i++];
    } else {
      i += best;
    }
  }
  return o;
}

static unsigned expand(unsigned n) {
  unsigned i, o = 0, k;
  for (i = 0; i + 1 < n; i += 2) {
    if (in[i] == 0) {
      out[o++] = in[i + 1];
    } else {
      for (k = 0; k < in[i + 1]; k++, o++) out[o] = out[o - in[i]];
    }
  }
  return o;
}

/* moves any number of bytes at any address in legal pieces */
static void move_bytes(unsigned char *ls, unsigned long long ea, unsigned n, int put) {
  while (n) {
    unsigned piece;
    if (((unsigned)ea & 15) == 0 && n >= 16) {
      piece = n & ~15u;
      if (piece > 16384) piece = 16384;
    } else {
      piece = 1;
      while (piece < 8 && 2 * piece <= n && ((unsigned)ea & (2 * piece - 1)) == 0) piece *= 2;
    }
    if (put)
      mfc_put(ls, ea, piece, 6, 0, 0);
    else
      mfc_get(ls, ea, piece, 6, 0, 0);
    ls += piece;
    ea += piece;
    n -= piece;
  }
  mfc_write_tag_mask(1 << 6);
  mfc_read_tag_status_all();
}

int main(unsigned long long id, unsigned long long argp, unsigned long long envp) {
  unsigned skew_in, skew_out, n;
  (void)id;
  mfc_get(&order, argp, sizeof order, 6, 0, 0);
  mfc_write_tag_mask(1 << 6);
  mfc_read_tag_status_all();
  if (order.in_bytes > LIMIT) return 1;
  skew_in = (unsigned)order.in & 15;
  skew_out = (unsigned)order.out & 15;
  move_bytes(in + skew_in, order.in, order.in_bytes, 0);
  memmove(in, in + skew_in, order.in_bytes);
  n = toupper((int)envp) == 'C' ? compress(order.in_bytes) : expand(order.in_bytes);
  memmove(out + skew_out, out, n);
  move_bytes(out + skew_out, order.out, n, 1);
  spu_write_out_mbox(n);
  return 0;
}
