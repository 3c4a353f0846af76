// rule: effective-address-as-pointer
// twin: legal/copied_through_local_store
// Follows the address that it was given: an SPU reaches main storage by DMA only.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t) {
  const volatile uint32_t* const data = reinterpret_cast<uint32_t*>(static_cast<uintptr_t>(argp));
  return data[0] == 0xFFFFFFFFu ? 1 : 0;  // BROKEN
}
