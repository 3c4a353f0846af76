#pragma once
// One run of a kernel on one or more SPEs.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernel_buffers.h"
#include "kernel_task.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/host_calls.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::tool {

/// The settings in which runs of the same task differ.
struct RunSettings {
  dma::Schedule schedule{};
  /// kSimulated: SPEs also take turns, so that the run is the same every time.
  ls_sim::Clock clock = ls_sim::Clock::kHost;
  /// Collects cycles. The clock is then the simulated one, and SPEs run in the order of its time.
  ls_sim::Timing* timing = nullptr;
  ls_sim::Debugger* debugger = nullptr;
  ls_sim::Trace* trace = nullptr;
  const ls_sim::HostCalls* host_calls = nullptr;
  /// Called every few milliseconds: if it returns true, the run ends as at its deadline. Empty: it is never interrupted.
  std::function<bool()> interrupted = {};
};

/// The result of one SPE, and what it left in its outbound mailboxes.
struct SpeRun {
  ls_sim::RunResult result;
  std::optional<std::uint32_t> out_mbox, out_intr_mbox;
  ls_sim::SpeStatistics statistics;
  bool interrupted = false;  ///< RunSettings::interrupted has ended it
};

/// "status 0", "stop code 0x3FFF", "interrupted", or the name of the rule that was broken.
std::string describe_end(const SpeRun& spe);

struct KernelRun {
  std::vector<SpeRun> spes;
  std::vector<ls_sim::Finding> findings;  ///< findings of a checked kernel

  /// A sentence for each SPE that did not end with status 0.
  std::vector<std::string> failures(const ls_sim::KernelImage& image) const;
};

/// Runs the image on SPEs 0 to task.spes - 1, all with the same arguments; main's first parameter tells each SPE its number. Always
/// returns, at the latest at the task's deadline.
KernelRun run_kernel(dma::AddressSpace& memory, const ls_sim::KernelImage& image,
                     const KernelBuffers& buffers, const KernelTask& task, const RunSettings& settings);

}  // namespace softcell::tool
