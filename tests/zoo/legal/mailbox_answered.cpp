// keeps: deadlock
// ppu: in_mbox=42
// Reads its mailbox, into which the PPU has written.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t) { return spu_read_in_mbox() == 42 ? 0 : 1; }
