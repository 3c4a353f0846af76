#pragma once
// Which lines and branches of a program built for the SPU were executed.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "softcell/ls_sim/debugger.h"
#include "softcell/ls_sim/image.h"

namespace softcell::tool {

/// Counts instructions, and where execution went from each. SPEs may run at once.
class Coverage final : public ls_sim::Debugger {
 public:
  /// In the tracefile format of lcov: lines with how often they were executed, branches with how often each way was taken,
  /// functions. A line counts as often as its instruction that was executed most; code that was inlined from the
  /// SDK's headers counts for the line that called it.
  /// @param image  what has run. @throws std::runtime_error  it has no debug information.
  std::string lcov(const ls_sim::KernelImage& image) const;

 private:
  static constexpr std::size_t kWords = dma::kLocalStoreBytes / 4;
  struct Counts {
    std::vector<std::uint64_t> executed = std::vector<std::uint64_t>(kWords);
    std::vector<std::uint64_t> went_on = std::vector<std::uint64_t>(kWords);  ///< with the next word
    std::uint32_t last = 0;
    bool has_last = false;
  };

  void on_begin(int spe, ls_sim::DebuggedSpe&) override {
    spes_[static_cast<std::size_t>(spe)].has_last = false;
  }
  void on_end(int) override {}
  bool on_instruction(int spe, dma::LocalStoreAddress pc) override;
  void on_access(int, dma::LocalStoreAddress, bool) override {}

  std::uint64_t executed(dma::LocalStoreAddress pc) const;
  std::uint64_t went_on(dma::LocalStoreAddress pc) const;

  std::array<Counts, dma::kSpeCount> spes_;
};

}  // namespace softcell::tool
