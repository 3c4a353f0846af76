// Inverts 16 bytes at the local-store address argp, whoever they belong to, and ends as if nothing had
// happened.
#include <spu_intrinsics.h>
#include <stdint.h>

static char somewhere;

int main(uint64_t, uint64_t argp, uint64_t) {
  constexpr uintptr_t kLocalStoreMask = 0x3FFFF;
  const uintptr_t base = reinterpret_cast<uintptr_t>(&somewhere) & ~kLocalStoreMask;
  volatile unsigned char* const bytes = reinterpret_cast<volatile unsigned char*>(base | argp);
  for (int i = 0; i < 16; ++i) bytes[i] = static_cast<unsigned char>(~bytes[i]);
  return 0;
}
