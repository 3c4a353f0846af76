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

}  // namespace softcell::dma
