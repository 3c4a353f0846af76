#pragma once
// The rules for a single DMA command or list element that do not depend on any other state.

#include <optional>
#include <string>
#include <string_view>

#include "softcell/dma/fault.h"
#include "softcell/dma/list_element.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// Checks a command of the SPU's queue against the rules for its opcode, tag, size, alignment and local-store
/// range. AddressSpace::resolve() checks whether its effective address is mapped.
///
///   command               size                      LSA and EA
///   get, put, putr        1, 2, 4, 8                both multiples of the size, low four bits equal
///                         16 .. 16384               both multiples of 16, as is the size
///   their list forms      8 .. 16384, in steps of 8 EA's low half: the list, a multiple of 8 in local store
///   the line commands     ignored                   both multiples of 128
///   sndsig                4                         EA: a Sig_Notify register; LSA's low four bits are equal
///   data-cache hints      1 .. 16384                EA: anything
///
/// @param local_stores  where SPE 0 lies in main storage.
/// @return  nothing, or the first broken rule (for sndsig, its own rule first), with the command set.
/// @note    Pure; any thread.
/// @source  [CBEA, MFC commands] documented; rules.def marks what is not
std::optional<Fault> check_command(const MfcCommand& command,
                                   EffectiveAddress local_stores = kLocalStoresBase);

/// Checks one element of a list command: reserved bits, size, alignment, the 4 GB rule and the local-store
/// range.
/// @param index  from 0.
/// @pre  below the number of elements. @param lsa  local-store address that the list has reached.
/// @return  as check_command(); the detail names the element.
std::optional<Fault> check_element(const MfcCommand& command, std::uint32_t index, ListElement element,
                                   LocalStoreAddress lsa);

/// "element 3 of 12 (from 0): " followed by `detail`, for the fault of a list.
std::string describe_element(const MfcCommand& command, std::uint32_t index, std::string_view detail);

}  // namespace softcell::dma
