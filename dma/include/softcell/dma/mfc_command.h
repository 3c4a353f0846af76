#pragma once
// One DMA command: what an SPU writes to the channels MFC_LSA, MFC_EAH, MFC_EAL, MFC_Size, MFC_TagID and
// MFC_Cmd.

#include <cstdint>
#include <string_view>

#include "softcell/dma/addresses.h"

namespace softcell::dma {

/// All opcodes in the manual's spelling, so that an unsupported one is refused by name.
enum class MfcOpcode : std::uint16_t {
#define SC_MFC_OPCODE(name, code) name = (code),
#include "softcell/dma/mfc_opcodes.def"
#undef SC_MFC_OPCODE
};

/// The opcode's name in the manual's spelling ("get", "putrlb"), or an empty string if it is no opcode.
std::string_view name(MfcOpcode opcode);

constexpr std::uint32_t kTagCount = 32;             // tag groups of one MFC [CBEA, MFC commands] documented
constexpr std::uint32_t kMaxTransferBytes = 16384;  // [CBEA, MFC commands] documented
constexpr std::uint32_t kListElementBytes = 8;      // [CBEA, MFC list commands] documented
constexpr std::uint32_t kSignalBytes = 4;           // [CBEA, sndsig] documented

/// What a command does with its parameters.
enum class CommandKind : std::uint8_t {
  kUnknown,
  kTransfer,  ///< get, put and putr: one range of up to 16 KB
  kList,      ///< their list forms: `ea` holds MFC_EAH and the list's local-store address, `size` its length
  kStart,     ///< their start forms, which belong to the proxy queue
  kLine,      ///< getllar, putllc, putlluc: one line, at once, without a tag; the size is ignored
  kQueuedLine,  ///< putqlluc: one line, through the queue; the size is ignored
  kSignal,      ///< sndsig: 4 bytes to a register
  kOrdering,    ///< barrier, mfceieio, mfcsync: no address, no size
  kCacheHint,   ///< sdcrt, sdcrtst, sdcrz, sdcrst, sdcrf: a range of main storage, no local store
};

/// A command as issued. It is checked when the MFC takes it (Mfc, mfc.h).
struct MfcCommand {
  /// MFC_Cmd: transfer class << 24 | replacement class << 16 | opcode. The classes are cache hints.
  std::uint32_t word = 0;
  LocalStoreAddress lsa = {};
  EffectiveAddress ea = {};
  std::uint32_t size = 0;  ///< bytes
  std::uint32_t tag = 0;

  constexpr MfcOpcode opcode() const { return static_cast<MfcOpcode>(word & 0xFFFF); }

  /// The kind of the opcode, whatever the parameters. Fast for plain gets and puts, which most commands are.
  CommandKind kind() const { return is_plain_transfer() ? CommandKind::kTransfer : kind_of_other(); }

  /// Main storage to local store, in any form (fence, barrier, list, start).
  constexpr bool is_get() const { return (word & 0xFFF0) == 0x40; }
  /// Local store to main storage, in any form.
  constexpr bool is_put() const { return (word & 0xFFE0) == 0x20; }
  /// Waits for every earlier command of its tag: the f forms, and putqlluc, whose fence its name does not
  /// show. [CBEA, MFC atomic update commands] documented
  constexpr bool has_fence() const {
    return (has_order_bits() && (word & 0x02) != 0) || opcode() == MfcOpcode::putqlluc;
  }
  /// A fence for which later commands of its tag wait, too: the b forms, mfceieio and mfcsync. (The last two
  /// also order accesses of other units, which are always in order here.)
  constexpr bool has_barrier() const {
    return (has_order_bits() && (word & 0x01) != 0) || opcode() == MfcOpcode::mfceieio ||
           opcode() == MfcOpcode::mfcsync;
  }
  /// Waits for every earlier command of the queue, of any tag, and every later one waits for it.
  constexpr bool is_queue_barrier() const { return opcode() == MfcOpcode::barrier; }

  /// The list of a list command: its address in local store, from MFC_EAL.
  constexpr LocalStoreAddress list_address() const { return {static_cast<std::uint32_t>(ea.value)}; }

  bool operator==(const MfcCommand&) const = default;

 private:
  /// get and put without and with fence or barrier.
  constexpr bool is_plain_transfer() const {
    return ((word & 0xFFFC) == 0x40 || (word & 0xFFFC) == 0x20) && (word & 0x03) != 0x03;
  }
  CommandKind kind_of_other() const;
  constexpr bool has_order_bits() const { return is_get() || is_put() || (word & 0xFFFC) == 0xA0; }
};

}  // namespace softcell::dma
