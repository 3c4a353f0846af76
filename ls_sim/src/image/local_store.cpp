#include "softcell/ls_sim/local_store.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "low_memory.h"
#include "softcell/base/assert.h"

namespace softcell::ls_sim {
namespace {

// One guard below, the arena, one guard above, and what alignment may cost.
constexpr std::size_t kMappingBytes = 4 * std::size_t{dma::kLocalStoreBytes};

}  // namespace

LocalStore::LocalStore(std::byte* place) : base_(place) {
  if (place != nullptr) {
    make_accessible();
    return;
  }
  mapping_ = reserve_below_4_gb(kMappingBytes, "a local store");
  const auto low = reinterpret_cast<std::uintptr_t>(mapping_) + kGuardBytes;
  const auto aligned = (low + dma::kLocalStoreMask) & ~std::uintptr_t{dma::kLocalStoreMask};
  base_ = reinterpret_cast<std::byte*>(aligned);
  SC_ASSERT(aligned + dma::kLocalStoreBytes + kGuardBytes <=
                reinterpret_cast<std::uintptr_t>(mapping_) + kMappingBytes,
            "the local store at {} and its guard leave the mapping at {}", base_, mapping_);
  make_accessible();
}

void LocalStore::make_accessible() {
  SC_ASSERT(base_ != nullptr && reinterpret_cast<std::uintptr_t>(base_) % dma::kLineBytes == 0,
            "a local store at {}", base_);
  if (mprotect(base_, dma::kLocalStoreBytes, PROT_READ | PROT_WRITE | PROT_EXEC) != 0) {
    const int error = errno;
    if (mapping_ != nullptr) munmap(mapping_, kMappingBytes);
    throw std::runtime_error(
        std::string("a local store cannot be made executable (is memory that is writable and "
                    "executable forbidden here?): ") +
        std::strerror(error));
  }
}

LocalStore::~LocalStore() {
  if (mapping_ != nullptr) {
    munmap(mapping_, kMappingBytes);
    return;
  }
  // The addresses stay taken, and the next local store there begins with zeros.
  madvise(base_, dma::kLocalStoreBytes, MADV_DONTNEED);
  mprotect(base_, dma::kLocalStoreBytes, PROT_NONE);
}

}  // namespace softcell::ls_sim
