#include <cstdlib>
extern "C" {
#include "../spes.h"
extern spe_program_handle_t sobel_spu;
}

namespace {
constexpr int kWidth = 64, kHeight = 32;
alignas(128) unsigned char image[kHeight][kWidth], edges[kHeight][kWidth];
}  // namespace

int main() {
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      image[y][x] =
          static_cast<unsigned char>((x - 30) * (x - 30) + (y - 15) * (y - 15) < 100 ? 200 : 10 + x);
  spe_t spe;
  start_spe(&spe, &sobel_spu, image, edges);
  int wrong = wait_spe(&spe) != 0;
  for (int y = 1; y + 1 < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      int value = 0;
      if (x > 0 && x + 1 < kWidth) {
        int gx = 0, gy = 0;
        for (int k = -1; k <= 1; ++k) {
          const int w = k == 0 ? 2 : 1;
          gx += w * (image[y + k][x + 1] - image[y + k][x - 1]);
          gy += w * (image[y + 1][x + k] - image[y - 1][x + k]);
        }
        value = std::abs(gx) + std::abs(gy);
      }
      if (edges[y][x] != 255 - (value > 255 ? 255 : value)) ++wrong;
    }
  }
  printf(wrong == 0 ? "ok\n" : "%d wrong\n", wrong);
  return wrong != 0;
}
