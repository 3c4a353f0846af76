// What the interposed allocator knows, if the program runs with it.

#include <dlfcn.h>
#include <elfutils/libdwfl.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>

#include "interposed_allocator.h"
#include "machine.h"
#include "softcell/base/text.h"
#include "softcell/dma/host_allocations.h"

namespace softcell::libspe2 {
namespace {

/// "queue.c:41" or "make_queue" or "an instruction at 0x..." of an address of this process.
std::string describe_code(std::uint64_t address) {
  static char* no_debuginfo_path = nullptr;
  static const Dwfl_Callbacks callbacks{.find_elf = dwfl_linux_proc_find_elf,
                                        .find_debuginfo = dwfl_standard_find_debuginfo,
                                        .section_address = nullptr,
                                        .debuginfo_path = &no_debuginfo_path};
  std::string text = "the instruction at " + base::hex(address);
  Dwfl* const dwfl = dwfl_begin(&callbacks);
  if (dwfl == nullptr) return text;
  if (dwfl_linux_proc_report(dwfl, getpid()) == 0 && dwfl_report_end(dwfl, nullptr, nullptr) == 0) {
    Dwfl_Module* const module = dwfl_addrmodule(dwfl, address);
    const char* const function = module == nullptr ? nullptr : dwfl_module_addrname(module, address);
    if (function != nullptr) text = function;
    Dwfl_Line* const line = module == nullptr ? nullptr : dwfl_module_getsrc(module, address);
    int number = 0;
    const char* const file =
        line == nullptr ? nullptr : dwfl_lineinfo(line, nullptr, &number, nullptr, nullptr, nullptr);
    if (file != nullptr) {
      const std::string place =
          std::filesystem::path(file).filename().string() + ":" + std::to_string(number);
      text = function == nullptr ? place : text + " at " + place;
    }
  }
  dwfl_end(dwfl);
  return text;
}

class InterposedAllocations final : public dma::HostAllocations {
 public:
  explicit InterposedAllocations(const SoftcellAllocator& allocator) : allocator_(allocator) {}

  std::optional<dma::HostAllocation> last_at_or_below(std::uint64_t address) const override {
    SoftcellAllocation block{};
    if (allocator_.last_at_or_below(address, &block) == 0) return std::nullopt;
    // The call itself lies before the place that it returns to.
    return dma::HostAllocation{.begin = block.begin,
                               .bytes = block.bytes,
                               .live = block.live != 0,
                               .made_at = describe_code(block.caller - 1)};
  }
  bool owns(std::uint64_t address) const override { return allocator_.owns(address) != 0; }
  std::uint64_t generation() const override { return allocator_.generation(); }

 private:
  const SoftcellAllocator& allocator_;
};

}  // namespace

const dma::HostAllocations* interposed_allocations() {
  const auto* const allocator =
      static_cast<const SoftcellAllocator*>(dlsym(RTLD_DEFAULT, "softcell_interposed_allocator"));
  if (allocator == nullptr) return nullptr;
  static const auto* const allocations = new InterposedAllocations(*allocator);
  return allocations;
}

}  // namespace softcell::libspe2
