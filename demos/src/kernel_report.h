#pragma once
// What a run of a kernel was like: for the reader, and for other programs.

#include <nlohmann/json_fwd.hpp>

#include "kernel_run.h"

namespace softcell::demos {

/// Prints the DMA traffic by kind, what each SPE did, and the use of the local store.
void print_statistics(const ls_sim::KernelImage& image, const KernelRun& run);

/// Prints findings and failures on standard error, a line each, a finding with its rule's explanation below
/// it.
void print_problems(const ls_sim::KernelImage& image, const KernelRun& run);

/// All of it.
nlohmann::ordered_json to_json(const ls_sim::KernelImage& image, const KernelRun& run);

/// 1 when an SPE failed, else 3 when there are findings, else 0.
int exit_status(const ls_sim::KernelImage& image, const KernelRun& run);

}  // namespace softcell::demos
