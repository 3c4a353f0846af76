#pragma once
// Cycles by instruction of a local store.

#include <array>
#include <cstdint>
#include <memory>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::ls_sim {

/// Counters for each word of a local store, made page by page as programs reach them. Used by the thread that runs the SPE.
class ProgramCycles {
 public:
  /// @pre pc is a multiple of 4 in the local store
  CycleCounts& at(std::uint32_t pc) {
    SC_ASSERT(pc < dma::kLocalStoreBytes && pc % 4 == 0, "an instruction at {}", pc);
    std::unique_ptr<Page>& page = pages_[pc / kPageBytes];
    if (__builtin_expect(page == nullptr, 0)) page = std::make_unique<Page>();
    return (*page)[pc % kPageBytes / 4];
  }
  CycleCounts read(std::uint32_t pc) const {
    SC_ASSERT(pc < dma::kLocalStoreBytes, "an instruction at {}", pc);
    const auto& page = pages_[pc / kPageBytes];
    return page == nullptr ? CycleCounts{} : (*page)[pc % kPageBytes / 4];
  }
  /// Calls `each(pc, counts)` for each instruction that was executed, in order of address.
  template <class Each>
  void for_each(Each&& each) const {
    for (std::uint32_t pc = 0; pc < dma::kLocalStoreBytes; pc += 4) {
      if (pages_[pc / kPageBytes] == nullptr) {
        pc += kPageBytes - 4;
        continue;
      }
      const CycleCounts counts = read(pc);
      if (counts.instructions != 0) each(pc, counts);
    }
  }

 private:
  static constexpr std::uint32_t kPageBytes = 2048;
  using Page = std::array<CycleCounts, kPageBytes / 4>;
  std::array<std::unique_ptr<Page>, dma::kLocalStoreBytes / kPageBytes> pages_;
};

}  // namespace softcell::ls_sim
