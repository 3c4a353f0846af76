/* FFT of 256 complex numbers in separate arrays, radix 2, with sines of the C library. */
#include <math.h>
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include "fft.h"

static float re[POINTS] __attribute__((aligned(128))), im[POINTS] __attribute__((aligned(128)));

static unsigned reverse(unsigned x, int bits) {
  unsigned r = 0;
  while (bits--) {
    r = r << 1 | (x & 1);
    x >>= 1;
  }
  return r;
}

static void swap(float *a, float *b) {
  float t = *a;
  *a = *b;
  *b = t;
}

int main(unsigned long long id, unsigned long long argp, unsigned long long envp) {
  unsigned i, size;
  (void)id;
  mfc_get(re, argp, sizeof re, 1, 0, 0);
  mfc_get(im, envp, sizeof im, 1, 0, 0);
  mfc_write_tag_mask(1 << 1);
  mfc_read_tag_status_all();
  for (i = 0; i < POINTS; i++) {
    unsigned j = reverse(i, 8);
    if (j > i) {
      swap(&re[i], &re[j]);
      swap(&im[i], &im[j]);
    }
  }
  for (size = 2; size <= POINTS; size *= 2) {
    unsigned half = size / 2, k;
    for (k = 0; k < half; k++) {
      const float angle = -2.0f * (float)M_PI * (float)k / (float)size;
      const float c = cosf(angle), s = sinf(angle);
      for (i = k; i < POINTS; i += size) {
        float xr = re[i + half] * c - im[i + half] * s, xi = re[i + half] * s + im[i + half] * c;
        re[i + half] = re[i] - xr;
        im[i + half] = im[i] - xi;
        re[i] += xr;
        im[i] += xi;
      }
    }
  }
  mfc_putb(re, argp, sizeof re, 1, 0, 0);
  mfc_putb(im, envp, sizeof im, 1, 0, 0);
  mfc_read_tag_status_all();
  return 0;
}
