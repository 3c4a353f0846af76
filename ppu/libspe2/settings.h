#pragma once
// Settings of a libspe2 program, from environment variables.

#include <chrono>
#include <string>

#include "softcell/dma/schedule.h"

namespace softcell::libspe2 {

/// The environment variables, which `softcell run` sets from its options. A variable that is empty counts as
/// not set.
struct Settings {
  dma::Schedule schedule;  ///< SOFTCELL_DMA: eager, lazy or random:SEED
  bool turns = false;      ///< SOFTCELL_TURNS: 0 or 1; SPEs run one at a time, drawn from the seed
  bool checked = false;    ///< SOFTCELL_CHECKED: 0 or 1
  std::chrono::milliseconds deadline{0};  ///< SOFTCELL_DEADLINE_MS: of one run; 0: none
  std::string trace_file;                 ///< SOFTCELL_TRACE, %p replaced
  std::string report_file;                ///< SOFTCELL_REPORT, %p replaced: what the run has done, as JSON
};

/// Reads them. @throws std::runtime_error  one has a value that is not allowed; the message names both.
Settings settings_from_environment();

}  // namespace softcell::libspe2
