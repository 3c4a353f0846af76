#pragma once
// SPEs awake, for benchmarks of what they then do.

#include "kernel_runs/kernel_file.h"
#include "softcell/jobs/job_system.h"

namespace softcell::tool {

/// An SPE that has slept for milliseconds takes the host 40 us to wake, whatever it is woken for: 7 % of
/// 16,000 particles. dispatch/round_trip measures that; a benchmark of something else has it done before its
/// time begins.
class SpeWaker {
 public:
  /// @param jobs  must outlive the waker
  explicit SpeWaker(ppu::JobSystem& jobs) : image_(jobs.load(kernel_)), chain_(jobs, "waker", 1) {
    chain_.add({image_, {}});  // returns at once
  }

  void wake() {
    chain_.kick();
    chain_.wait();
  }

 private:
  ls_sim::KernelImage kernel_ = load_kernel("transfers");
  ppu::JobImage image_;
  ppu::JobChain chain_;
};

}  // namespace softcell::tool
