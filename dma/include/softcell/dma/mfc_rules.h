#pragma once
// What makes a single DMA command legal, whatever else is going on.

#include <optional>

#include "softcell/dma/fault.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// Checks a command against the rules for its opcode, tag, size, alignment and local-store range. Whether its
/// effective address is mapped is the address space's to say (AddressSpace::resolve).
///
///   size            LSA and EA
///   1, 2, 4, 8      both multiples of the size, low four bits equal
///   16 .. 16384     both multiples of 16, as is the size
///
/// @return  nothing, or the first rule broken, in the order of rules.def, with the command set. Of the known
///          commands, get, put and putr are executed, with their fence and barrier forms; the others are
///          refused by name (command-not-supported).
/// @note    Pure; any thread.
/// @source  [CBEA, MFC commands] documented; what is not is marked in rules.def
std::optional<Fault> check_command(const MfcCommand& command);

}  // namespace softcell::dma
