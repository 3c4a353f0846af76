/* Mandelbrot set, four points at a time; each SPE has every n-th row. */
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include "mandelbrot.h"

static params_t p __attribute__((aligned(16)));
static unsigned char row[2][WIDTH] __attribute__((aligned(128)));

static vector unsigned int iterate(vector float cx, vector float cy) {
  vector float x = spu_splats(0.0f), y = x;
  vector unsigned int count = spu_splats(0u);
  int i;
  for (i = 0; i < MAX_ITER; i++) {
    vector float xx = spu_mul(x, x), yy = spu_mul(y, y);
    vector unsigned int inside = spu_cmpgt(spu_splats(4.0f), spu_add(xx, yy));
    if (spu_extract(spu_gather(inside), 0) == 0) break;
    count = spu_sub(count, inside);
    y = spu_madd(spu_mul(x, y), spu_splats(2.0f), cy);
    x = spu_add(spu_sub(xx, yy), cx);
  }
  return count;
}

int main(unsigned long long id, unsigned long long argp, unsigned long long envp) {
  unsigned int r, c, i, buffer = 0;
  (void)id; (void)envp;
  mfc_get(&p, argp, sizeof p, 31, 0, 0);
  mfc_write_tag_mask(1 << 31);
  mfc_read_tag_status_all();
  for (r = p.first_row; r < p.rows; r += p.row_stride) {
    vector float cy = spu_splats(p.y0 + p.step * (float)r);
    /* this buffer's last put has to be done */
    mfc_write_tag_mask(1 << buffer);
    mfc_read_tag_status_all();
    for (c = 0; c < WIDTH; c += 4) {
      vector float column = {0.0f, 1.0f, 2.0f, 3.0f};
      vector float cx = spu_madd(spu_add(column, spu_splats((float)c)), spu_splats(p.step), spu_splats(p.x0));
      vector unsigned int n = iterate(cx, cy);
      for (i = 0; i < 4; i++) row[buffer][c + i] = (unsigned char)spu_extract(n, i);
    }
    mfc_put(row[buffer], p.image + r * WIDTH, WIDTH, buffer, 0, 0);
    buffer ^= 1;
  }
  mfc_write_tag_mask(3);
  mfc_read_tag_status_all();
  return 0;
}
