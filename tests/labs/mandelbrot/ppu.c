#include "../spes.h"
#include "mandelbrot.h"

extern spe_program_handle_t mandelbrot_spu;
static unsigned char image[HEIGHT * WIDTH] __attribute__((aligned(128)));

int main(void) {
  static params_t params[6] __attribute__((aligned(16)));
  spe_t spes[6];
  unsigned int i, x, y, wrong = 0, inside = 0;
  for (i = 0; i < 6; i++) {
    params[i].image = (unsigned long)image;
    params[i].x0 = -2.0f;
    params[i].y0 = -0.75f;
    params[i].step = 0.0234375f;
    params[i].first_row = i;
    params[i].row_stride = 6;
    params[i].rows = HEIGHT;
    start_spe(&spes[i], &mandelbrot_spu, &params[i], NULL);
  }
  for (i = 0; i < 6; i++) wrong += wait_spe(&spes[i]) != 0;
  for (y = 0; y < HEIGHT; y++) {
    for (x = 0; x < WIDTH; x++) {
      double cx = -2.0 + 0.0234375 * x, cy = -0.75 + 0.0234375 * y, a = 0, b = 0;
      int n = 0;
      while (n < MAX_ITER && a * a + b * b < 4) {
        double t = a * a - b * b + cx;
        b = 2 * a * b + cy;
        a = t;
        n++;
      }
      inside += n == MAX_ITER;
      /* near the edge single precision may differ */
      if (n < 20 && abs(n - image[y * WIDTH + x]) > 1) wrong++;
      if (n == MAX_ITER && image[y * WIDTH + x] < MAX_ITER / 2) wrong++;
    }
  }
  printf(wrong == 0 && inside > 500 ? "ok\n" : "%u wrong, %u inside\n", wrong, inside);
  return wrong != 0;
}
