#pragma once
// One DMA command: what an SPU writes to the channels MFC_LSA, MFC_EAH, MFC_EAL, MFC_Size, MFC_TagID and
// MFC_Cmd.

#include <cstdint>
#include <string_view>

#include "softcell/dma/addresses.h"

namespace softcell::dma {

/// The opcodes, in the manual's spelling; all of them, so that an unsupported one is refused by name.
enum class MfcOpcode : std::uint16_t {
#define SC_MFC_OPCODE(name, code) name = (code),
#include "softcell/dma/mfc_opcodes.def"
#undef SC_MFC_OPCODE
};

/// The manual's spelling ("get", "putrlb"), or an empty string for a value that is no command.
std::string_view name(MfcOpcode opcode);

constexpr std::uint32_t kTagCount = 32;             // tag groups of one MFC [CBEA, MFC commands] documented
constexpr std::uint32_t kMaxTransferBytes = 16384;  // [CBEA, MFC commands] documented

/// A command as issued; nothing is checked here, see check_command() in mfc_rules.h.
struct MfcCommand {
  /// MFC_Cmd: transfer class << 24 | replacement class << 16 | opcode. The classes are cache hints.
  std::uint32_t word = 0;
  LocalStoreAddress lsa = {};
  EffectiveAddress ea = {};
  std::uint32_t size = 0;  ///< bytes
  std::uint32_t tag = 0;

  constexpr MfcOpcode opcode() const { return static_cast<MfcOpcode>(word & 0xFFFF); }

  /// Main storage to local store, in any form (fence, barrier, list, start).
  constexpr bool is_get() const { return (word & 0xFFF0) == 0x40; }
  /// Local store to main storage, in any form.
  constexpr bool is_put() const { return (word & 0xFFE0) == 0x20; }
  /// Waits for every earlier command of its tag; true for the f forms only.
  constexpr bool has_fence() const { return has_order_bits() && (word & 0x02) != 0; }
  /// As a fence, and later commands of its tag wait for it; true for the b forms.
  constexpr bool has_barrier() const { return has_order_bits() && (word & 0x01) != 0; }

  bool operator==(const MfcCommand&) const = default;

 private:
  constexpr bool has_order_bits() const { return is_get() || is_put() || (word & 0xFFFC) == 0xA0; }
};

}  // namespace softcell::dma
