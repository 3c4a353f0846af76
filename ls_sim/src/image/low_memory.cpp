#include "low_memory.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"

namespace softcell::ls_sim {
namespace {

constexpr std::uintptr_t kEnd = std::uintptr_t{1} << 32;
// Below lie programs that are linked at a fixed address, their heap, and the low words of addresses in main memory.
constexpr std::uintptr_t kSearchBegin = std::uintptr_t{512} << 20;
constexpr std::uintptr_t kSearchStep = std::uintptr_t{1} << 20;

void* reserve(void* place, std::size_t bytes, int flags) {
  return mmap(place, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | flags, -1, 0);
}

}  // namespace

void* reserve_below_4_gb(std::size_t bytes, const char* what) {
  SC_ASSERT(bytes != 0 && bytes < kEnd - kSearchBegin, "{} of {} bytes", what, bytes);
  // The kernel looks between 1 and 2 GB. All else that is free below 4 GB is looked for here.
  void* mapping = reserve(nullptr, bytes, MAP_32BIT);
  for (std::uintptr_t at = kSearchBegin; mapping == MAP_FAILED && at + bytes <= kEnd; at += kSearchStep) {
    void* const place = reinterpret_cast<void*>(at);
    mapping = reserve(place, bytes, MAP_FIXED_NOREPLACE);
    if (mapping != MAP_FAILED &&
        mapping != place) {  // a kernel before Linux 4.17 takes the address as a wish
      munmap(mapping, bytes);
      mapping = MAP_FAILED;
      errno = ENOMEM;
    }
  }
  if (mapping == MAP_FAILED) {
    throw std::runtime_error(
        std::string(what) + " cannot be reserved: this process has no " + std::to_string(bytes / 1024) +
        " KB free below 4 GB, which the 32-bit pointers of kernels need: " + std::strerror(errno));
  }
  return mapping;
}

}  // namespace softcell::ls_sim
