#include "softcell/ls_sim/local_store.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"

namespace softcell::ls_sim {
namespace {

// One guard below, the arena, one guard above, and what alignment may cost.
constexpr std::size_t kMappingBytes = 4 * std::size_t{dma::kLocalStoreBytes};

}  // namespace

LocalStore::LocalStore() {
  mapping_ = mmap(nullptr, kMappingBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapping_ == MAP_FAILED) {
    throw std::runtime_error(std::string("a local store cannot be reserved: ") + std::strerror(errno));
  }
  const auto low = reinterpret_cast<std::uintptr_t>(mapping_) + kGuardBytes;
  const auto aligned = (low + dma::kLocalStoreMask) & ~std::uintptr_t{dma::kLocalStoreMask};
  base_ = reinterpret_cast<std::byte*>(aligned);
  SC_ASSERT(aligned + dma::kLocalStoreBytes + kGuardBytes <=
                reinterpret_cast<std::uintptr_t>(mapping_) + kMappingBytes,
            "the local store at {} and its guard leave the mapping at {}", base_, mapping_);
  if (mprotect(base_, dma::kLocalStoreBytes, PROT_READ | PROT_WRITE | PROT_EXEC) != 0) {
    const int error = errno;
    munmap(mapping_, kMappingBytes);
    throw std::runtime_error(
        std::string("a local store cannot be made executable (is memory that is writable and "
                    "executable forbidden here?): ") +
        std::strerror(error));
  }
}

LocalStore::~LocalStore() { munmap(mapping_, kMappingBytes); }

}  // namespace softcell::ls_sim
