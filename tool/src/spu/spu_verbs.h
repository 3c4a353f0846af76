#pragma once
// softcell spu: run, explore, timing, disasm, debug, budget.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command_line/verb.h"
#include "kernel_runs/kernel_samples.h"
#include "kernel_runs/kernel_task.h"
#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/spe_options.h"

namespace softcell::tool {

struct BudgetOptions {
  std::vector<std::string> kernels;  ///< names or files; empty: all kernels of softcell
  bool checked = false;
  bool functions = false;  ///< also list where the samples spend their cycles
  std::optional<std::filesystem::path> json;
};

struct SpuRunOptions {
  KernelTask task;
  dma::Schedule schedule{};
  ls_sim::Clock clock = ls_sim::Clock::kHost;
  /// Programs built for the SPU may print, and may use files in `folder` if there is one.
  bool host_calls = false;
  std::optional<std::filesystem::path> folder;
  bool timing = false;  ///< count cycles by the timing model of the SPU
  std::optional<std::filesystem::path> coverage;
  std::optional<std::filesystem::path> trace;
  std::optional<std::filesystem::path> json;
};

/// For `spu timing` and for `spu disasm`, which runs nothing.
struct SpuListingOptions {
  KernelTask task;
  dma::Schedule schedule{};
  std::string function;        ///< empty: all
  bool is_static = false;      ///< run nothing
  bool with_schedule = false;  ///< for `spu disasm`
  bool host_calls = false;
  std::optional<std::filesystem::path> json;
};

struct SpuDebugOptions {
  KernelTask task;
  dma::Schedule schedule{};
  std::uint16_t port = 0;  ///< 0: any free port
};

struct SpuExploreOptions {
  KernelTask task;
  std::string task_text;  ///< the options that make the task, for repeating it
  std::uint64_t seeds = 100;
  bool quiet = false;  ///< print errors only
  std::optional<std::filesystem::path> json;
};

/// @param samples  work by which the stacks of softcell's own kernels are measured; other kernels are not measured
int run_budget(const BudgetOptions& options, std::span<const KernelSample> samples);
/// @return  0; 1 if an SPE failed; 3 if a checked kernel has findings.
int run_spu_run(const SpuRunOptions& options);
/// Prints the static schedule, and the cycles that a run took. @return  as for run_spu_run()
int run_spu_timing(const SpuListingOptions& options);
int run_spu_disasm(const SpuListingOptions& options);
/// Waits for a debugger, and serves it. Writes no buffers. @return  as for run_spu_run(); 0 if the debugger has killed the program.
int run_spu_debug(const SpuDebugOptions& options);
/// @return  as for run_spu_run() if all seeds agree, 1 if they do not, 130 if interrupted.
int run_spu_explore(const SpuExploreOptions& options);

/// @param samples  as for run_budget()
std::unique_ptr<Verb> spu_verbs(std::vector<KernelSample> samples);

}  // namespace softcell::tool
