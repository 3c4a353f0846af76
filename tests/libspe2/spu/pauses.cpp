// Stops with 0x11, 0x12 and 0x13, counting; then ends with the count.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t envp) {
  unsigned int count = static_cast<unsigned int>(argp + envp);
  spu_stop(0x11);
  ++count;
  spu_stop(0x12);
  ++count;
  spu_stop(0x13);
  ++count;
  return static_cast<int>(count);
}
