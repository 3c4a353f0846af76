// An image filter by DMA lists: three rows are gathered by one list command, and patterns move pixels in registers.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <stdlib.h>

static const unsigned int width = 64, height = 32;
static unsigned char rows[3][width] __attribute__((aligned(128)));
static unsigned char result[width] __attribute__((aligned(128)));
static mfc_list_element_t list[3] __attribute__((aligned(8)));

int main(unsigned long long spe, unsigned long long source, unsigned long long target) {
  (void)spe;
  for (unsigned int y = 1; y + 1 < height; ++y) {
    for (unsigned int k = 0; k < 3; ++k) {
      list[k].notify = 0;
      list[k].size = width;
      list[k].eal = mfc_ea2l(source + (y + k - 1) * width);
    }
    mfc_getl(rows, source, list, sizeof list, 9, 0, 0);
    mfc_write_tag_mask(1u << 9);
    mfc_read_tag_status_all();
    for (unsigned int x = 0; x < width; ++x) {
      int value = 0;
      if (x > 0 && x + 1 < width) {
        const int gx = rows[0][x + 1] + 2 * rows[1][x + 1] + rows[2][x + 1] - rows[0][x - 1] -
                       2 * rows[1][x - 1] - rows[2][x - 1];
        const int gy = rows[2][x - 1] + 2 * rows[2][x] + rows[2][x + 1] - rows[0][x - 1] - 2 * rows[0][x] -
                       rows[0][x + 1];
        value = abs(gx) + abs(gy);
      }
      result[x] = static_cast<unsigned char>(value > 255 ? 255 : value);
    }
    // Inverted, sixteen pixels at once.
    vec_uchar16* pixels = reinterpret_cast<vec_uchar16*>(result);
    for (unsigned int i = 0; i < width / 16; ++i)
      pixels[i] = spu_xor(pixels[i], static_cast<unsigned char>(0xFF));
    mfc_put(result, target + y * width, width, 10, 0, 0);
    mfc_write_tag_mask(1u << 10);
    mfc_read_tag_status_all();
  }
  return 0;
}
