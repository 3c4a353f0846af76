#pragma once
// Reports a run of a kernel, for the reader and for other programs.

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "kernel_runs/kernel_run.h"

namespace softcell::tool {

/// Prints the DMA traffic by kind, what each SPE did, and the use of the local store.
void print_statistics(const ls_sim::KernelImage& image, const KernelRun& run);

/// Prints findings on standard error, a line each, with the rule's explanation below it.
void print_findings(std::span<const ls_sim::Finding> findings);

/// Prints findings, and a line for each failure.
void print_problems(const ls_sim::KernelImage& image, const KernelRun& run);

/// Findings as an array of objects with rule, kernel, place, message, explanation and count.
nlohmann::ordered_json to_json(std::span<const ls_sim::Finding> findings);

/// The whole run.
nlohmann::ordered_json to_json(const ls_sim::KernelImage& image, const KernelRun& run);

/// 1 if an SPE failed, else 3 if there are findings, else 0.
int exit_status(const ls_sim::KernelImage& image, const KernelRun& run);

}  // namespace softcell::tool
