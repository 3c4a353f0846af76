#pragma once
// A representative piece of work for each kernel, by which its needs are measured.

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

/// One SPE that runs a kernel alone, so that all the stack in use is the kernel's.
class SampleRun {
 public:
  /// @param kernel  must outlive this object
  explicit SampleRun(const ls_sim::KernelImage& kernel) : kernel_(kernel) {}

  /// Runs the kernel. May be called again.
  /// @param pieces  the work that this run does, counted in KernelSample::piece
  /// @throws std::runtime_error  the kernel failed.
  void run(dma::EffectiveAddress argp, std::size_t pieces = 1);
  /// Adds to the pieces of work that all runs together have done.
  void worked(std::size_t pieces) { pieces_ += pieces; }
  /// Call it after the runs that only measure the stack; the time of later runs counts.
  void begin_timing();

  dma::AddressSpace& memory() { return memory_; }
  std::uint32_t stack_used() const { return spes_.statistics(0).stack_high_water; }
  /// Cycles per piece of work on a PS3, waits included. None: the kernel is built for the host, for which only waits are known.
  std::optional<double> cycles_a_piece() const;
  std::size_t pieces() const { return pieces_; }
  /// The functions that the counted cycles were spent in, the one with most cycles first.
  std::vector<ls_sim::FunctionCycles> functions() const;

 private:
  ls_sim::SpeOptions options();

  const ls_sim::KernelImage& kernel_;
  dma::AddressSpace memory_;
  ls_sim::Timing timing_{1};
  ls_sim::SpeGroup spes_{memory_, options()};
  std::uint64_t begin_ = 0;
  std::vector<ls_sim::FunctionCycles> before_;  // the cycles of functions in the runs that measured the stack
  std::size_t pieces_ = 0;
};

/// The work of one kernel.
struct KernelSample {
  std::string_view kernel;
  std::string_view piece;  ///< unit in which its cycles are given: "particle"
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

/// Samples that need nothing but their job: for job_loop, rotations and transfers.
std::span<const KernelSample> plain_samples();

/// None: the kernel has no sample.
/// @throws std::runtime_error  the sample failed.
std::optional<SampleNeeds> measure(const ls_sim::KernelImage& kernel, std::span<const KernelSample> samples);

}  // namespace softcell::tool
