#pragma once
// The cycles of a run: for the reader, and for other programs.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/timing.h"

namespace softcell::tool {

/// Prints for each SPE cycles, instructions, stalls by cause and waits, and the same by function.
/// @param image  what has run on all SPEs
void print_timing(const ls_sim::KernelImage& image, const ls_sim::Timing& timing);

/// Prints a row for each function, under a heading that begins with `what`.
void print_functions(const std::string& what, const std::vector<ls_sim::FunctionCycles>& functions);

nlohmann::ordered_json to_json(const ls_sim::CycleCounts& counts);
/// Name, address and counts of each.
nlohmann::ordered_json to_json(const std::vector<ls_sim::FunctionCycles>& functions);
nlohmann::ordered_json to_json(const ls_sim::KernelImage& image, const ls_sim::Timing& timing);

}  // namespace softcell::tool
