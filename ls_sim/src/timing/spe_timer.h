#pragma once
// All that is timed of one SPE.

#include <atomic>
#include <cstdint>

#include "job_cycles.h"
#include "mfc_timer.h"
#include "port_use.h"
#include "program_cycles.h"
#include "simulated_clock.h"

namespace softcell::ls_sim {

/// Used by the thread that runs the SPE.
class SpeTimer {
 public:
  SpeTimer(int spe, ElementInterconnect& interconnect, const TimingParameters& model)
      : parameters(model), mfc(spe, interconnect, port, model) {}

  const TimingParameters& parameters;
  SimulatedClock clock;
  PortUse port;
  MfcTimer mfc;
  ProgramCycles program;
  PipelineCounts pipeline;
  JobTimer jobs;
  CycleCounts native;  ///< of kernels built for the host, whose instructions nobody sees
  std::uint64_t tag_waits = 0, queue_waits = 0, other_waits = 0;
};

}  // namespace softcell::ls_sim
