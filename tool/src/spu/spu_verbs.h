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
  std::vector<std::string> kernels;  ///< names or files; empty: all of softcell's own
  bool checked = false;
  bool functions = false;  ///< where the cycles of samples went
  std::optional<std::filesystem::path> json;
};

struct SpuRunOptions {
  KernelTask task;
  dma::Schedule schedule{};
  ls_sim::Clock clock = ls_sim::Clock::kHost;
  /// Programs built for the SPU may print, and use files in `folder` if there is one.
  bool host_calls = false;
  std::optional<std::filesystem::path> folder;
  bool timing = false;  ///< cycles by the model of the SPU
  std::optional<std::filesystem::path> coverage;
  std::optional<std::filesystem::path> trace;
  std::optional<std::filesystem::path> json;
};

/// Of `spu timing`, and of `spu disasm`, which runs nothing.
struct SpuListingOptions {
  KernelTask task;
  dma::Schedule schedule{};
  std::string function;        ///< empty: all
  bool is_static = false;      ///< run nothing
  bool with_schedule = false;  ///< of `spu disasm`
  bool host_calls = false;
  std::optional<std::filesystem::path> json;
};

struct SpuDebugOptions {
  KernelTask task;
  dma::Schedule schedule{};
  std::uint16_t port = 0;  ///< 0: any that is free
};

struct SpuExploreOptions {
  KernelTask task;
  std::string task_text;  ///< the options that make the task, to be typed again
  std::uint64_t seeds = 100;
  bool quiet = false;  ///< no progress, even on a terminal
  std::optional<std::filesystem::path> json;
};

/// @param samples  of work, to measure the stacks of softcell's own kernels with; others are not measured
int run_budget(const BudgetOptions& options, std::span<const KernelSample> samples);
/// @return  0; 1 when an SPE failed; 3 when a checked kernel has findings.
int run_spu_run(const SpuRunOptions& options);
/// The static schedule, and what a run took. @return  as run_spu_run()
int run_spu_timing(const SpuListingOptions& options);
int run_spu_disasm(const SpuListingOptions& options);
/// Waits for a debugger, and serves it. Writes no buffers. @return  as run_spu_run(); 0 when the debugger has killed the program.
int run_spu_debug(const SpuDebugOptions& options);
/// @return  as run_spu_run() when all seeds agree, 1 when they do not, 130 when interrupted.
int run_spu_explore(const SpuExploreOptions& options);

/// @param samples  as run_budget()
std::unique_ptr<Verb> spu_verbs(std::vector<KernelSample> samples);

}  // namespace softcell::tool
