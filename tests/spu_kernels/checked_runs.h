#pragma once
// Runs of instrumented kernels under several DMA schedules, in which nothing may be found.

#include <gtest/gtest.h>

#include <exception>
#include <string>

#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/spe_options.h"

namespace softcell::test {

/// Behind a failure that some DMA schedules show and others do not.
inline constexpr const char* kDependsOnTheSchedule =
    "\nthe bytes depend on the DMA schedule: a transfer of the kernel lacks its fence (a get where a getf "
    "belongs) or its wait; which, the tests of checked kernels say";

/// Calls run(options), whose kernels are to be checked, and fails with each finding.
template <typename Run>
void expect_no_findings(const Run& run) {
  for (const char* schedule : {"eager", "lazy", "random:1", "random:2"}) {
    SCOPED_TRACE(schedule);
    ls_sim::Findings findings;
    std::string thrown;
    try {
      run(ls_sim::SpeOptions{.spes = 2, .schedule = dma::parse_schedule(schedule), .findings = &findings});
    } catch (const std::exception& error) {
      thrown = error.what();
    }
    for (const ls_sim::Finding& finding : findings.list()) {
      const bool unordered = finding.fault.rule == dma::Rule::kTransfersOverlap;
      ADD_FAILURE() << finding.fault.message()
                    << (unordered
                            ? "\na fence is missing (getf in place of get), or a wait for the command in "
                              "flight: the order of the two is open"
                            : "");
    }
    if (!thrown.empty()) ADD_FAILURE() << "the run ended: " << thrown;
  }
}

}  // namespace softcell::test
