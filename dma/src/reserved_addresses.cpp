#include "reserved_addresses.h"

#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

#include "softcell/dma/addresses.h"

namespace softcell::dma {
namespace {

void reserve(EffectiveAddress begin, std::uint64_t bytes) {
  // The raw system call: thread sanitizer's mmap would end the process over an address outside of its own
  // layout, where nothing is accessible anyway.
  const long result = syscall(SYS_mmap, begin.value, bytes, PROT_NONE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE, -1, 0);
  // Kernels before 4.17 take MAP_FIXED_NOREPLACE for a wish and may map elsewhere.
  const auto mapped = static_cast<std::uint64_t>(result);
  if (result != -1 && mapped != begin.value) syscall(SYS_munmap, mapped, bytes);
}

}  // namespace

void reserve_effective_addresses() {
  [[maybe_unused]] static const bool once = [] {
    reserve(kMainMemoryBase, kMaxMainMemoryBytes);
    reserve(kVideoMemoryBase, kVideoMemoryBytes);
    reserve(kLocalStoresBase, kSpeCount * kLocalStoreStrideBytes);
    return true;
  }();
}

}  // namespace softcell::dma
