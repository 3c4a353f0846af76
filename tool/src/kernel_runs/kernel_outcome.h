#pragma once
// The outcome of a run, and the differences between two runs of one task: a kernel whose outcome depends on when its
// transfers happen is wrong.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kernel_run.h"

namespace softcell::tool {

/// The part of a run that must not depend on the schedule: how each SPE ended, the findings, and the written buffers. The counts of
/// findings, times, and counts of waits may depend on it.
struct KernelOutcome {
  struct Contents {
    std::string name;
    std::vector<std::byte> bytes;
  };
  std::vector<std::string> ends;      ///< one for each SPE
  std::vector<std::string> findings;  ///< rule and place of each
  std::vector<Contents> buffers;      ///< of --out and --inout
};

KernelOutcome outcome(const KernelRun& run, const KernelBuffers& buffers);

/// One difference between two outcomes.
struct Difference {
  std::string what;          ///< "buffer y", "SPE 0", "findings"
  std::uint64_t offset = 0;  ///< in a buffer: of the first byte that differs
  std::uint64_t bytes = 0;   ///< in a buffer: how many differ; 0 for anything else
  std::string first, other;  ///< the two values

  std::string sentence(const std::string& first_run, const std::string& other_run) const;
};

/// All differences: first of SPEs, then of findings, then of buffers. @pre both are outcomes of one task.
std::vector<Difference> differences(const KernelOutcome& first, const KernelOutcome& other);

nlohmann::ordered_json to_json(const Difference& difference);

}  // namespace softcell::tool
