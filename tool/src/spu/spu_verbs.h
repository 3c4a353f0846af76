#pragma once
// softcell spu: run, explore, budget.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command_line/verb.h"
#include "kernel_samples.h"
#include "kernel_task.h"
#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/spe_options.h"

namespace softcell::tool {

struct BudgetOptions {
  std::vector<std::string> kernels;  ///< names or files; empty: all of softcell's own
  bool checked = false;
  std::optional<std::filesystem::path> json;
};

struct SpuRunOptions {
  KernelTask task;
  dma::Schedule schedule{};
  ls_sim::Clock clock = ls_sim::Clock::kHost;
  std::optional<std::filesystem::path> trace;
  std::optional<std::filesystem::path> json;
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
/// @return  as run_spu_run() when all seeds agree, 1 when they do not, 130 when interrupted.
int run_spu_explore(const SpuExploreOptions& options);

/// @param samples  as run_budget()
std::unique_ptr<Verb> spu_verbs(std::vector<KernelSample> samples);

}  // namespace softcell::tool
