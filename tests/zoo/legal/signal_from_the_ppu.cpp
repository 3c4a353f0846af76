// keeps: deadlock
// ppu: signal2=42
// Waits at the second signal register, to which the PPU writes.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) { return spu_read_signal2() == 42 ? 0 : 1; }
