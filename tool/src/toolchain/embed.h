#pragma once
// Turns SPU programs into objects for the PPU side.

#include "process.h"

namespace softcell::toolchain {

/// softcell-embedspu [OPTIONS] SYMBOL INPUT OUTPUT: an object with `spe_program_handle_t SYMBOL`. [embedspu] documented
/// @return  the status of the command. @throws std::invalid_argument  wrong usage, in one sentence.
int embedspu(const Words& words);

/// softcell-bin2s INPUT: assembly of the file as an array, on standard output. [PSL1GHT, bin2s] documented
int bin2s(const Words& words);

}  // namespace softcell::toolchain
