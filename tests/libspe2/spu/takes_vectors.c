/* A program whose main takes whole registers, in C; takes_vectors_in_cxx.cpp includes it. Its status is the number of words that are not
 * as the PPU side has given them: 1 to 12, or without SPE_RUN_USER_REGS the number 0x0000000500000006 and zeros. */
#include <spu_intrinsics.h>

int main(vec_uint4 one, vec_uint4 two, vec_uint4 three) {
  unsigned int i;
  int wrong = 0;
  if (spu_extract(two, 2) == 0) {
    wrong = spu_extract(two, 0) != 5 || spu_extract(two, 1) != 6 || spu_extract(two, 3) != 0;
    return wrong + (spu_extract(three, 0) != 0) + (spu_extract(three, 1) != 0);
  }
  for (i = 0; i < 4; ++i) {
    wrong += spu_extract(one, i) != i + 1;
    wrong += spu_extract(two, i) != i + 5;
    wrong += spu_extract(three, i) != i + 9;
  }
  return wrong;
}
