#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

std::string_view name(MfcOpcode opcode) {
  switch (opcode) {
#define SC_MFC_OPCODE(name, code) \
  case MfcOpcode::name:           \
    return #name;
#include "softcell/dma/mfc_opcodes.def"
#undef SC_MFC_OPCODE
  }
  return {};
}

CommandKind MfcCommand::kind() const {
  constexpr std::uint32_t kListBit = 0x04;
  constexpr std::uint32_t kStartBit = 0x08;
  if (is_get() || is_put()) {
    if (name(opcode()).empty()) return CommandKind::kUnknown;
    if ((word & kListBit) != 0) return CommandKind::kList;
    return (word & kStartBit) != 0 ? CommandKind::kStart : CommandKind::kTransfer;
  }
  switch (opcode()) {
    case MfcOpcode::getllar:
    case MfcOpcode::putllc:
    case MfcOpcode::putlluc:
      return CommandKind::kLine;
    case MfcOpcode::putqlluc:
      return CommandKind::kQueuedLine;
    case MfcOpcode::sndsig:
    case MfcOpcode::sndsigf:
    case MfcOpcode::sndsigb:
      return CommandKind::kSignal;
    case MfcOpcode::barrier:
    case MfcOpcode::mfceieio:
    case MfcOpcode::mfcsync:
      return CommandKind::kOrdering;
    case MfcOpcode::sdcrt:
    case MfcOpcode::sdcrtst:
    case MfcOpcode::sdcrz:
    case MfcOpcode::sdcrst:
    case MfcOpcode::sdcrf:
      return CommandKind::kCacheHint;
    default:
      return CommandKind::kUnknown;
  }
}

}  // namespace softcell::dma
