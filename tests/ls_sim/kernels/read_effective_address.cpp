// Follows an effective address as if it were a pointer.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t) {
  return *reinterpret_cast<volatile int*>(static_cast<uintptr_t>(argp));
}
