// The gate's address below 4 GB: a page with a jump to the gate, which lies with the rest of the program,
// anywhere. The jump leaves the stack as it is, so that the gate sees its caller.

#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

#include "image/low_memory.h"
#include "kernel_context.h"
#include "softcell/base/assert.h"

namespace softcell::ls_sim::native {
namespace {

constexpr std::size_t kPageBytes = 4096;

// jmp *0(%rip), and behind it the address.  [AMD64 manual 3, JMP near indirect] documented
constexpr std::array<unsigned char, 6> kJumpToWhatFollows = {0xFF, 0x25, 0, 0, 0, 0};

std::uint32_t make_page() {
  void* const page = reserve_below_4_gb(kPageBytes, "the kernels' entry to the emulator");
  SC_ASSERT(reinterpret_cast<std::uintptr_t>(page) + kPageBytes <= std::uint64_t{1} << 32,
            "the gate's page lies at {}", page);
  const auto target = reinterpret_cast<std::uint64_t>(&gate);
  bool made = mprotect(page, kPageBytes, PROT_READ | PROT_WRITE) == 0;
  if (made) {
    std::memcpy(page, kJumpToWhatFollows.data(), kJumpToWhatFollows.size());
    std::memcpy(static_cast<std::byte*>(page) + kJumpToWhatFollows.size(), &target, sizeof target);
    made = mprotect(page, kPageBytes, PROT_READ | PROT_EXEC) == 0;
  }
  if (!made) {
    const int error = errno;
    munmap(page, kPageBytes);
    throw std::runtime_error(std::string("the kernels' entry to the emulator cannot be made executable: ") +
                             std::strerror(error));
  }
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(page));
}

}  // namespace

std::uint32_t gate_below_4_gb() {
  static const std::uint32_t address = make_page();
  return address;
}

}  // namespace softcell::ls_sim::native
