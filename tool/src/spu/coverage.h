#pragma once
// Finds out which lines and branches of a kernel were executed.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "softcell/ls_sim/debugger.h"
#include "softcell/ls_sim/image.h"

namespace softcell::tool {

/// Counts executed instructions, and where execution went from each. SPEs may run at the same time.
class Coverage final : public ls_sim::Debugger {
 public:
  /// @param image  the image that will run; must outlive this object.
  explicit Coverage(const ls_sim::KernelImage& image);

  /// The counts in lcov's tracefile format: how often lines were executed, how often branches went each way, and functions. A line counts
  /// as often as its most executed instruction; code that was inlined from the SDK's headers counts for the line that called it.
  /// @throws std::runtime_error  the image has no debug information.
  std::string lcov() const;

 private:
  /// Counts of one SPE by address.
  struct Counts {
    std::vector<std::uint64_t> executed = std::vector<std::uint64_t>(dma::kLocalStoreBytes);
    /// How often execution went on with the next instruction.
    std::vector<std::uint64_t> went_on = std::vector<std::uint64_t>(dma::kLocalStoreBytes);
    std::uint32_t last = 0;
    std::uint32_t next = kNowhere;  ///< the address after the last one
  };
  static constexpr std::uint32_t kNowhere = ~0u;

  void on_begin(int spe, ls_sim::DebuggedSpe&) override {
    spes_[static_cast<std::size_t>(spe)].next = kNowhere;
  }
  void on_end(int) override {}
  bool on_instruction(int spe, dma::LocalStoreAddress pc) override;
  void on_access(int, dma::LocalStoreAddress, bool) override {}

  std::uint32_t behind(std::uint32_t pc) const;
  std::uint64_t executed(dma::LocalStoreAddress pc) const;
  std::uint64_t went_on(dma::LocalStoreAddress pc) const;

  const ls_sim::KernelImage& image_;
  std::array<Counts, dma::kSpeCount> spes_;
};

}  // namespace softcell::tool
