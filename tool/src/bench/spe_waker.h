#pragma once
// Wakes SPEs, for benchmarks of what they do then.

#include "kernel_runs/kernel_file.h"
#include "softcell/jobs/job_system.h"

namespace softcell::tool {

/// The host takes 40 us to wake an SPE that has slept for milliseconds, whatever it is woken for: 7 % of the time for 16,000 particles.
/// dispatch/round_trip measures that; other benchmarks wake their SPE before their timed part.
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
