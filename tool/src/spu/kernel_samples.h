#pragma once
// A representative piece of work for each kernel, for measuring what it needs.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "softcell/dma/address_space.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"

namespace softcell::tool {

/// One SPE that runs a kernel alone, so that all the stack it uses is the kernel's.
class SampleRun {
 public:
  /// @param kernel  must outlive it
  explicit SampleRun(const ls_sim::KernelImage& kernel) : kernel_(kernel) {}

  /// May be called again. @throws std::runtime_error  the kernel failed.
  void run(dma::EffectiveAddress argp);

  dma::AddressSpace& memory() { return memory_; }
  std::uint32_t stack_used() const { return spes_.statistics(0).stack_high_water; }

 private:
  const ls_sim::KernelImage& kernel_;
  dma::AddressSpace memory_;
  ls_sim::SpeGroup spes_{memory_, {.spes = 1, .measure_stack = true}};
};

/// The work of one kernel.
struct KernelSample {
  std::string_view kernel;
  void (*run)(SampleRun& sample);
};

/// Those that need nothing but their job: of job_loop, rotations and transfers.
std::span<const KernelSample> plain_samples();

/// Bytes of stack that the kernel used at most on its sample of work. None: it has no sample.
/// @throws std::runtime_error  the sample failed.
std::optional<std::uint32_t> measure_stack(const ls_sim::KernelImage& kernel,
                                           std::span<const KernelSample> samples);

}  // namespace softcell::tool
