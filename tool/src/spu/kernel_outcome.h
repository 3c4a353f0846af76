#pragma once
// What a run came to, and how two runs of one task differ: a kernel whose outcome depends on when its
// transfers happened is wrong.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kernel_run.h"

namespace softcell::tool {

/// All that must not depend on the schedule: how each SPE ended, which findings there are, the written
/// buffers. How often a finding occurred, times and counts of waits may depend on it.
struct KernelOutcome {
  struct Contents {
    std::string name;
    std::vector<std::byte> bytes;
  };
  std::vector<std::string> ends;      ///< of each SPE
  std::vector<std::string> findings;  ///< rule and place
  std::vector<Contents> buffers;      ///< of --out and --inout
};

KernelOutcome outcome(const KernelRun& run, const KernelBuffers& buffers);

/// One thing that two outcomes do not share.
struct Difference {
  std::string what;          ///< "buffer y", "SPE 0", "findings"
  std::uint64_t offset = 0;  ///< of a buffer: its first byte that differs
  std::uint64_t bytes = 0;   ///< of a buffer: how many differ; 0 for anything else
  std::string first, other;  ///< both values

  std::string sentence(const std::string& first_run, const std::string& other_run) const;
};

/// In order: SPEs, findings, buffers. Empty when the two are the same. @pre outcomes of one task.
std::vector<Difference> differences(const KernelOutcome& first, const KernelOutcome& other);

nlohmann::ordered_json to_json(const Difference& difference);

}  // namespace softcell::tool
