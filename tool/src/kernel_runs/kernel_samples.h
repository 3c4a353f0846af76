#pragma once
// A representative piece of work for each kernel, for measuring what it needs.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "softcell/dma/address_space.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::tool {

/// One SPE that runs a kernel alone, so that all the stack it uses is the kernel's.
class SampleRun {
 public:
  /// @param kernel  must outlive it
  explicit SampleRun(const ls_sim::KernelImage& kernel) : kernel_(kernel) {}

  /// May be called again.
  /// @param pieces  of work that is done then: KernelSample::piece
  /// @throws std::runtime_error  the kernel failed.
  void run(dma::EffectiveAddress argp, std::size_t pieces = 1);
  /// More pieces of work are done, by all runs together.
  void worked(std::size_t pieces) { pieces_ += pieces; }
  /// What has run so far was to measure the stack; the time of what comes now counts.
  void begin_timing();

  dma::AddressSpace& memory() { return memory_; }
  std::uint32_t stack_used() const { return spes_.statistics(0).stack_high_water; }
  /// For a piece of work, on a PS3, waits included. None: the kernel is built for the host, of which only waits are known.
  std::optional<double> cycles_a_piece() const;
  std::size_t pieces() const { return pieces_; }
  /// Those in which the cycles went by that count, the one with most first.
  std::vector<ls_sim::FunctionCycles> functions() const;

 private:
  ls_sim::SpeOptions options();

  const ls_sim::KernelImage& kernel_;
  dma::AddressSpace memory_;
  ls_sim::Timing timing_{1};
  ls_sim::SpeGroup spes_{memory_, options()};
  std::uint64_t begin_ = 0;
  std::vector<ls_sim::FunctionCycles> before_;  // what functions took to measure the stack
  std::size_t pieces_ = 0;
};

/// The work of one kernel.
struct KernelSample {
  std::string_view kernel;
  std::string_view piece;  ///< what its cycles are counted for: "particle"
  void (*run)(SampleRun& sample);
};

/// What a kernel needed for its sample of work.
struct SampleNeeds {
  std::uint32_t stack = 0;  ///< bytes, at most
  std::optional<double> cycles = {};
  std::string_view piece = {};
  std::size_t pieces = 0;
  std::vector<ls_sim::FunctionCycles> functions = {};
};

/// Those that need nothing but their job: of job_loop, rotations and transfers.
std::span<const KernelSample> plain_samples();

/// None: the kernel has no sample.
/// @throws std::runtime_error  the sample failed.
std::optional<SampleNeeds> measure(const ls_sim::KernelImage& kernel, std::span<const KernelSample> samples);

}  // namespace softcell::tool
