#pragma once
// The cycles of jobs that a resident kernel calls, by the kernel of the job.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "simulated_clock.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::ls_sim {

/// Times the jobs of one SPE. Used by the thread that runs it.
class JobTimer {
 public:
  void begin(const SimulatedClock& clock) { begin_ = clock.now(), waited_ = clock.waited(); }
  /// @param kernel  of the job that began last
  void end(const KernelImage& kernel, const SimulatedClock& clock) {
    KernelCycles& of = of_kernel(kernel);
    ++of.jobs;
    of.cycles += clock.now() - begin_;
    of.waits += clock.waited() - waited_;
  }

  const std::vector<KernelCycles>& kernels() const { return kernels_; }

 private:
  KernelCycles& of_kernel(const KernelImage& kernel) {
    const auto known = std::ranges::find(kernels_, kernel.name, &KernelCycles::kernel);
    return known != kernels_.end() ? *known : kernels_.emplace_back(KernelCycles{.kernel = kernel.name});
  }

  std::uint64_t begin_ = 0, waited_ = 0;
  std::vector<KernelCycles> kernels_;  ///< few
};

}  // namespace softcell::ls_sim
