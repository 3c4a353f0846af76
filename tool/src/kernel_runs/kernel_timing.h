#pragma once
// Reports the cycles of a run, for the reader and for other programs.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::tool {

/// Prints cycles, instructions, stalls by cause and waits for each SPE, then for each function.
/// @param image  the image that all SPEs have run
void print_timing(const ls_sim::KernelImage& image, const ls_sim::Timing& timing);

/// Prints a row for each function, under a heading that begins with `what`.
void print_functions(const std::string& what, const std::vector<ls_sim::FunctionCycles>& functions);

nlohmann::ordered_json to_json(const ls_sim::CycleCounts& counts);
/// Name, address and counts of each function.
nlohmann::ordered_json to_json(const std::vector<ls_sim::FunctionCycles>& functions);
nlohmann::ordered_json to_json(const ls_sim::KernelImage& image, const ls_sim::Timing& timing);

}  // namespace softcell::tool
