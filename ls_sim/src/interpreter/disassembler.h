#pragma once
// Instructions as text, in the notation of GNU objdump.

#include <cstdint>
#include <string>

#include "instruction_set.h"

namespace softcell::ls_sim::interpreter {

/// "ai $3,$4,-1", "brnz $5,0x120". A word that is no instruction is ".long 0x...".
/// @param address  of the instruction: targets are printed as local-store addresses.
std::string disassemble(const Operation& operation, std::uint32_t address);

}  // namespace softcell::ls_sim::interpreter
