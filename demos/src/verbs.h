#pragma once
// One function for each verb of the command, each in a file of its name. They print their result on standard
// output.
// @throws UsageError (exit status 2) or another std::exception (exit status 1), one sentence either way.

#include "options.h"

namespace softcell::demos {

/// @return the exit status: 0, 3 when checked kernels have findings, or 130 when interrupted.
int run_demo_2d(const Demo2dOptions& options);
int run_demo_3d(const Demo3dOptions& options);
int run_scenes();
int run_budget(const BudgetOptions& options);
int run_bench(const BenchOptions& options);
int run_report(const ReportOptions& options);

/// @return  0; 1 when an SPE failed; 3 when a checked kernel has findings.
int run_spu_run(const SpuRunOptions& options);
/// @return  as run_spu_run() when all seeds agree, 1 when they do not, 130 when interrupted.
int run_spu_explore(const SpuExploreOptions& options);

}  // namespace softcell::demos
