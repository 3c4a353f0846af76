// Says where its words are. The PPU puts 256 of them there by proxy DMA and says so; the sum goes behind them, from where
// the PPU fetches it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile unsigned int words[260];

int main(uint64_t, uint64_t, uint64_t) {
  spu_write_out_mbox(static_cast<unsigned int>(reinterpret_cast<uintptr_t>(words) & 0x3FFFF));
  while (spu_read_in_mbox() != 0) {
    unsigned int sum = 0;
    for (unsigned int i = 0; i < 256; ++i) sum += words[i];
    for (unsigned int i = 0; i < 4; ++i) words[256 + i] = sum;
    spu_write_out_mbox(sum);
  }
  return 0;
}
