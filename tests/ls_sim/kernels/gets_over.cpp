// Gets 128 bytes from argp to the local-store address envp, whoever they belong to, and does not wait.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static char somewhere;

int main(uint64_t, uint64_t argp, uint64_t envp) {
  constexpr uintptr_t kLocalStoreMask = 0x3FFFF;
  const uintptr_t base = reinterpret_cast<uintptr_t>(&somewhere) & ~kLocalStoreMask;
  mfc_get(reinterpret_cast<void*>(base | envp), argp, 128, 9, 0, 0);
  return 0;
}
